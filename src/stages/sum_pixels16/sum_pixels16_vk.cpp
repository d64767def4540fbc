#include "stages/sum_pixels16/sum_pixels16_vk.h"

#include "stages/sum_pixels16/sum_pixels16_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kSumPixels16Code[] = {
#include "spirv/sum_pixels16.comp.inc"
};

}  // namespace

Result<SumPixels16> SumPixels16::make(const Device& device) {
  SumPixels16 out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"sum_pixels16", kSumPixels16Code, 2, sizeof(SumPixels16Push)}));
  return out;
}

void SumPixels16::record(Recorder& recorder, const Tensors16& x, int shift, const Tensors16& y) const {
  DUO_CHECK(y.pixels() == 1 && x.channels == y.channels && shift <= 15 && x.pixels() <= 1 << shift);
  DUO_CHECK(x.held() && y.held() && x.pictures == y.pictures);
  const SumPixels16Push push{x.view.plane, y.view.plane, y.channels, y.size.width, y.size.height, x.pixels(), shift};
  recorder.dispatch(kernel_, push, {reads(x.view), writes(y.view)}, groups_for(y));
}

}  // namespace duo::vk
