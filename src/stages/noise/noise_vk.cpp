#include "stages/noise/noise_vk.h"

#include "stages/noise/noise_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kNoiseBlocksCode[] = {
#include "spirv/noise_blocks.comp.inc"
};
constexpr std::uint32_t kNoiseCode[] = {
#include "spirv/noise.comp.inc"
};

}  // namespace

Result<Noise::Scratch> Noise::Scratch::make(const Device& device) {
  Scratch out;
  DUO_TRY_ASSIGN(out.bins_,
                 Buffer::make(device, "noise bins", 2 * std::size_t{kNoiseBins} * sizeof(std::uint32_t), Memory::kDevice));
  return out;
}

Result<Noise> Noise::make(const Device& device) {
  Noise out;
  DUO_TRY_ASSIGN(out.blocks_, Kernel::make(device, {"noise blocks", kNoiseBlocksCode, 3, sizeof(NoiseBlocksPush)}));
  DUO_TRY_ASSIGN(out.level_, Kernel::make(device, {"noise", kNoiseCode, 2, sizeof(NoisePush)}));
  return out;
}

void Noise::record(Recorder& recorder, BufferView<std::uint8_t> left, BufferView<std::uint8_t> right, const Scratch& scratch,
                   const Buffer& noise_q4, Size size) const {
  DUO_CHECK(left.holds(size) && right.holds(size) && noise_q4.bytes() >= sizeof(std::uint32_t));
  const int across = noise_blocks(size.width, kNoiseBlock), down = noise_blocks(size.height, kNoiseRowStep);
  if (across * down == 0) return recorder.fill(noise_q4, 0);
  recorder.fill(scratch.bins_, 0);
  recorder.dispatch(blocks_, NoiseBlocksPush{left.plane, right.plane, across, down},
                    {reads(left), reads(right), writes(scratch.bins_)}, {(across * down + kNoiseGroup - 1) / kNoiseGroup, 2});
  recorder.dispatch(level_, NoisePush{kNoiseShare}, {reads(scratch.bins_), writes(noise_q4)}, {1, 1});
}

}  // namespace duo::vk
