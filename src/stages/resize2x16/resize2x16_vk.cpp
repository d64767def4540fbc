#include "stages/resize2x16/resize2x16_vk.h"

#include "vulkan/value_lanes.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kResize2x16Code[] = {
#include "spirv/resize2x16.comp.inc"
};

}  // namespace

Result<Resize2x16> Resize2x16::make(const Device& device) {
  Resize2x16 out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"resize2x16", kResize2x16Code, 2, sizeof(ValuesPush)}));
  return out;
}

void Resize2x16::record(Recorder& recorder, const Tensors16& x, const Tensors16& y) const {
  DUO_CHECK(y.size.width == 2 * x.size.width && y.size.height == 2 * x.size.height && x.channels == y.channels);
  DUO_CHECK(x.held() && y.held() && x.pictures == y.pictures);
  const ValuesPush push{x.view.plane, y.view.plane, y.channels, y.size.width, y.size.height};
  recorder.dispatch(kernel_, push, {reads(x.view), writes(y.view)}, groups_for(y));
}

}  // namespace duo::vk
