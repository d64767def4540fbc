#include "stages/bilateral/bilateral_vk.h"

#include "stages/bilateral/bilateral_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kBilateralCode[] = {
#include "spirv/bilateral.comp.inc"
};

}  // namespace

Result<Bilateral> Bilateral::make(const Device& device) {
  Bilateral out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"bilateral", kBilateralCode, 3, sizeof(BilateralPush)}));
  return out;
}

void Bilateral::record(Recorder& recorder, BufferView<std::uint8_t> src, const Buffer& noise_q4, BufferView<std::uint8_t> dst,
                       Size size) const {
  DUO_CHECK(src.holds(size) && dst.holds(size) && noise_q4.bytes() >= sizeof(std::uint32_t));
  recorder.dispatch(kernel_, BilateralPush{src.plane, dst.plane, size.width, size.height},
                    {reads(src), reads(noise_q4), writes(dst)}, groups_for(size));
}

}  // namespace duo::vk
