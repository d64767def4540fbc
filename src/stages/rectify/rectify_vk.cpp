#include "stages/rectify/rectify_vk.h"

#include "stages/rectify/rectify_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kCode[] = {
#include "spirv/rectify.comp.inc"
};

}  // namespace

Result<Rectify> Rectify::make(const Device& device) {
  Rectify out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"rectify", kCode, 5, sizeof(RectifyPush)}));
  return out;
}

void Rectify::record(Recorder& recorder, BufferView<std::uint8_t> src, const Map& map, BufferView<std::uint8_t> dst,
                     BufferView<std::uint8_t> inside, Size size) const {
  DUO_CHECK(!src.absent() && map.corner.holds(size) && map.fraction_q8.holds(size) && dst.holds(size) && inside.holds(size));
  const RectifyPush push{src.plane, map.corner.plane, map.fraction_q8.plane, dst.plane, inside.plane, size.width, size.height};
  recorder.dispatch(kernel_, push, {reads(src), reads(map.corner), reads(map.fraction_q8), writes(dst), writes(inside)},
                    groups_for(size));
}

}  // namespace duo::vk
