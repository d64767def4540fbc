#include "stages/depth_to_space16/depth_to_space16_vk.h"

#include "vulkan/value_lanes.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kDepthToSpace16Code[] = {
#include "spirv/depth_to_space16.comp.inc"
};

}  // namespace

Result<DepthToSpace16> DepthToSpace16::make(const Device& device) {
  DepthToSpace16 out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"depth_to_space16", kDepthToSpace16Code, 2, sizeof(ValuesPush)}));
  return out;
}

void DepthToSpace16::record(Recorder& recorder, const Tensors16& x, const Tensors16& y) const {
  DUO_CHECK(y.size.width == 2 * x.size.width && y.size.height == 2 * x.size.height && x.channels == 4 * y.channels);
  DUO_CHECK(x.held() && y.held() && x.pictures == y.pictures);
  const ValuesPush push{x.view.plane, y.view.plane, y.channels, y.size.width, y.size.height};
  recorder.dispatch(kernel_, push, {reads(x.view), writes(y.view)}, groups_for(y));
}

}  // namespace duo::vk
