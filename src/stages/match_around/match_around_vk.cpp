#include "stages/match_around/match_around_vk.h"

#include "stages/match_around/match_around_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kCode[] = {
#include "spirv/match_around.comp.inc"
};

}  // namespace

Result<MatchAround> MatchAround::make(const Device& device) {
  MatchAround out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"match around", kCode, 6, sizeof(MatchAroundPush)}));
  return out;
}

void MatchAround::record(Recorder& recorder, const Input& in, BufferView<std::int16_t> dst, Size size) const {
  const bool whole_row = in.coarser.absent(), masked = !in.left_inside.absent();
  DUO_CHECK(in.left.holds(size) && in.right.holds(size) && dst.holds(size));
  DUO_CHECK(whole_row || in.coarser.holds({(size.width + 1) / 2, (size.height + 1) / 2}));
  DUO_CHECK(masked ? in.left_inside.holds(size) && in.right_inside.holds(size) : in.right_inside.absent());
  const MatchAroundPush push{in.left.plane,
                             in.right.plane,
                             in.left_inside.plane,
                             in.right_inside.plane,
                             in.coarser.plane,
                             dst.plane,
                             size.width,
                             size.height,
                             in.radius,
                             whole_row,
                             masked};
  // Every binding needs a buffer; the kernel does not look at those that stand in for absent ones.
  const auto present = [&](const auto& view) { return view.absent() ? reads(in.left) : reads(view); };
  recorder.dispatch(
      kernel_, push,
      {reads(in.left), reads(in.right), present(in.left_inside), present(in.right_inside), present(in.coarser), writes(dst)},
      groups_for(size));
}

}  // namespace duo::vk
