#include "stages/gaussian/gaussian_vk.h"

#include "stages/gaussian/gaussian_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kGaussianCode[] = {
#include "spirv/gaussian.comp.inc"
};

}  // namespace

Result<Gaussian> Gaussian::make(const Device& device) {
  Gaussian out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"gaussian", kGaussianCode, 2, sizeof(GaussianPush)}));
  return out;
}

void Gaussian::record(Recorder& recorder, BufferView<std::uint8_t> src, BufferView<std::uint8_t> dst, Size size) const {
  DUO_CHECK(src.holds(size) && dst.holds(size));
  const GaussianPush push{src.plane, dst.plane, size.width, size.height};
  recorder.dispatch(kernel_, push, {reads(src), writes(dst)}, groups_for(size));
}

}  // namespace duo::vk
