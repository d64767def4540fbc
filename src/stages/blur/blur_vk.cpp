#include "stages/blur/blur_vk.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kBlurBlocksCode[] = {
#include "spirv/blur_blocks.comp.inc"
};
constexpr std::uint32_t kBlurCode[] = {
#include "spirv/blur.comp.inc"
};

}  // namespace

Result<Blur> Blur::make(const Device& device) {
  Blur out;
  DUO_TRY_ASSIGN(out.measure_, BlockMeasure::make(device, {"blur", kBlurBlocksCode, kBlurCode, kBlurShare, kBlurUnknown}));
  return out;
}

Result<Blur::Scratch> Blur::make_scratch(const Device& device) { return Scratch::make(device, "blur", 4 * kBlurBins); }

void Blur::record(Recorder& recorder, BufferView<std::uint8_t> left, BufferView<std::uint8_t> right, const Scratch& scratch,
                  const Buffer& blur_q4, Size size) const {
  DUO_CHECK(left.holds(size) && right.holds(size) && blur_q4.bytes() >= sizeof(std::uint32_t));
  const Size blocks = {blur_blocks(size.width, kBlurBlock), blur_blocks(size.height, kBlurRowStep)};
  measure_.record(recorder, left, right, blocks, scratch, blur_q4);
}

}  // namespace duo::vk
