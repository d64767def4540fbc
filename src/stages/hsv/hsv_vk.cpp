#include "stages/hsv/hsv_vk.h"

#include "stages/hsv/hsv_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kHsvCode[] = {
#include "spirv/hsv.comp.inc"
};

}  // namespace

Result<Hsv> Hsv::make(const Device& device) {
  Hsv out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"hsv", kHsvCode, 4, sizeof(HsvPush)}));
  return out;
}

void Hsv::record(Recorder& recorder, BufferView<Rgb8> src, const Planes& dst, Size size) const {
  static_assert(sizeof(Rgb8) == 3);
  DUO_CHECK(src.holds(size) && dst.hue.holds(size) && dst.saturation.holds(size) && dst.value.holds(size));
  const HsvPush push{src.plane, dst.hue.plane, dst.saturation.plane, dst.value.plane, size.width, size.height};
  recorder.dispatch(kernel_, push, {reads(src), writes(dst.hue), writes(dst.saturation), writes(dst.value)}, groups_for(size));
}

}  // namespace duo::vk
