#include "stages/check_left_right/check_left_right_vk.h"

#include "stages/check_left_right/check_left_right_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kCheckLeftRightCode[] = {
#include "spirv/check_left_right.comp.inc"
};

// -1 of winners and Disparity::kNone have the same bits, so one kernel serves both.
template <class T>
void record_check(const Kernel& kernel, Recorder& recorder, const CheckLeftRight::Input& in, BufferView<T> value,
                  BufferView<T> dst, Size size) {
  const bool masked = !in.left_inside.absent();
  DUO_CHECK(in.left.holds(size) && in.right.holds(size) && value.holds(size) && dst.holds(size));
  DUO_CHECK(masked ? in.left_inside.holds(size) && in.right_inside.holds(size) : in.right_inside.absent());
  const CheckLeftRightPush push{in.left.plane, in.right.plane, in.left_inside.plane, in.right_inside.plane, value.plane,
                                dst.plane,     size.width,     size.height,          in.tolerance,          in.reach,
                                masked};
  // Every binding needs a buffer; the kernel does not look at those that stand in for absent ones.
  const auto present = [&](const auto& view) { return view.absent() ? reads(in.left) : reads(view); };
  recorder.dispatch(
      kernel, push,
      {reads(in.left), reads(in.right), present(in.left_inside), present(in.right_inside), reads(value), writes(dst)},
      groups_for(size));
}

}  // namespace

Result<CheckLeftRight> CheckLeftRight::make(const Device& device) {
  CheckLeftRight out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"check left right", kCheckLeftRightCode, 6, sizeof(CheckLeftRightPush)}));
  return out;
}

void CheckLeftRight::record_winners(Recorder& recorder, const Input& in, BufferView<std::int16_t> dst, Size size) const {
  record_check(kernel_, recorder, in, in.left, dst, size);
}

void CheckLeftRight::record(Recorder& recorder, const Input& in, BufferView<std::uint16_t> fine, BufferView<std::uint16_t> dst,
                            Size size) const {
  record_check(kernel_, recorder, in, fine, dst, size);
}

}  // namespace duo::vk
