#include "stages/noise/noise_vk.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kNoiseBlocksCode[] = {
#include "spirv/noise_blocks.comp.inc"
};
constexpr std::uint32_t kNoiseCode[] = {
#include "spirv/noise.comp.inc"
};

}  // namespace

Result<Noise> Noise::make(const Device& device) {
  Noise out;
  DUO_TRY_ASSIGN(out.measure_, BlockMeasure::make(device, {"noise", kNoiseBlocksCode, kNoiseCode, kNoiseShare, 0}));
  return out;
}

Result<Noise::Scratch> Noise::make_scratch(const Device& device) { return Scratch::make(device, "noise", 2 * kNoiseBins); }

void Noise::record(Recorder& recorder, BufferView<std::uint8_t> left, BufferView<std::uint8_t> right, const Scratch& scratch,
                   const Buffer& noise_q4, Size size) const {
  DUO_CHECK(left.holds(size) && right.holds(size) && noise_q4.bytes() >= sizeof(std::uint32_t));
  const Size blocks = {noise_blocks(size.width, kNoiseBlock), noise_blocks(size.height, kNoiseRowStep)};
  measure_.record(recorder, left, right, blocks, scratch, noise_q4);
}

}  // namespace duo::vk
