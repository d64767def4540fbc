#include "stages/mark_invalid/mark_invalid_vk.h"

#include "stages/mark_invalid/mark_invalid_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kMarkInvalidCode[] = {
#include "spirv/mark_invalid.comp.inc"
};

}  // namespace

Result<MarkInvalid> MarkInvalid::make(const Device& device) {
  MarkInvalid out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"mark invalid", kMarkInvalidCode, 4, sizeof(MarkInvalidPush)}));
  return out;
}

void MarkInvalid::record(Recorder& recorder, const Input& in, BufferView<std::uint16_t> dst, Size size) const {
  const bool masked = !in.left_inside.absent();
  DUO_CHECK(in.winner.holds(size) && dst.holds(size));
  DUO_CHECK(masked ? in.left_inside.holds(size) && in.right_inside.holds(size) : in.right_inside.absent());
  const MarkInvalidPush push{in.winner.plane, in.left_inside.plane, in.right_inside.plane, dst.plane,
                             size.width,      size.height,          in.max_disparity,      masked};
  // Every binding needs a buffer; the kernel does not look at those that stand in for absent ones.
  const auto present = [&](const auto& view) { return view.absent() ? reads(in.winner) : reads(view); };
  recorder.dispatch(kernel_, push, {reads(in.winner), present(in.left_inside), present(in.right_inside), writes(dst)},
                    groups_for(size));
}

}  // namespace duo::vk
