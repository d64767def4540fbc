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

Result<Blur::Scratch> Blur::Scratch::make(const Device& device) {
  Scratch out;
  DUO_TRY_ASSIGN(out.bins_,
                 Buffer::make(device, "blur bins", 4 * std::size_t{kBlurBins} * sizeof(std::uint32_t), Memory::kDevice));
  return out;
}

Result<Blur> Blur::make(const Device& device) {
  Blur out;
  DUO_TRY_ASSIGN(out.blocks_, Kernel::make(device, {"blur blocks", kBlurBlocksCode, 3, sizeof(BlurBlocksPush)}));
  DUO_TRY_ASSIGN(out.ratio_, Kernel::make(device, {"blur", kBlurCode, 2, sizeof(BlurPush)}));
  return out;
}

void Blur::record(Recorder& recorder, BufferView<std::uint8_t> left, BufferView<std::uint8_t> right, const Scratch& scratch,
                  const Buffer& blur_q4, Size size) const {
  DUO_CHECK(left.holds(size) && right.holds(size) && blur_q4.bytes() >= sizeof(std::uint32_t));
  const int across = blur_blocks(size.width, kBlurBlock), down = blur_blocks(size.height, kBlurRowStep);
  if (across * down == 0) return recorder.fill(blur_q4, kBlurUnknown);
  recorder.fill(scratch.bins_, 0);
  recorder.dispatch(blocks_, BlurBlocksPush{left.plane, right.plane, across, down},
                    {reads(left), reads(right), writes(scratch.bins_)}, {(across * down + kBlurGroup - 1) / kBlurGroup, 2});
  recorder.dispatch(ratio_, BlurPush{kBlurShare}, {reads(scratch.bins_), writes(blur_q4)}, {1, 1});
}

}  // namespace duo::vk
