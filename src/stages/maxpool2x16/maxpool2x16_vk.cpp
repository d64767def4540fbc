#include "stages/maxpool2x16/maxpool2x16_vk.h"

#include "vulkan/value_lanes.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kMaxpool2x16Code[] = {
#include "spirv/maxpool2x16.comp.inc"
};

}  // namespace

Result<Maxpool2x16> Maxpool2x16::make(const Device& device) {
  Maxpool2x16 out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"maxpool2x16", kMaxpool2x16Code, 2, sizeof(ValuesPush)}));
  return out;
}

void Maxpool2x16::record(Recorder& recorder, const Tensors16& x, const Tensors16& y) const {
  DUO_CHECK(x.size.width == 2 * y.size.width && x.size.height == 2 * y.size.height && x.channels == y.channels);
  DUO_CHECK(x.held() && y.held() && x.pictures == y.pictures);
  const ValuesPush push{x.view.plane, y.view.plane, y.channels, y.size.width, y.size.height};
  recorder.dispatch(kernel_, push, {reads(x.view), writes(y.view)}, groups_for(y));
}

}  // namespace duo::vk
