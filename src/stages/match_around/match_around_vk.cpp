#include "stages/match_around/match_around_vk.h"

#include <algorithm>

#include "stages/match_around/match_around_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kMatchAroundCode[] = {
#include "spirv/match_around.comp.inc"
};

// Workgroups of blocks of 2x2 pixels, each with several invocations where there are few of them.
struct Groups {
  int blocks_x, blocks_y, parts;
  Size count;
};

Groups groups_of(Size size, int candidates) {
  constexpr int kEnough = 1 << 16;  // invocations: half of what the largest devices hold at once
  const Size blocks{(size.width + 1) / 2, (size.height + 1) / 2};
  const int chunks = (candidates + kAroundCandidates - 1) / kAroundCandidates;
  Groups out;
  out.parts = 1;
  while (out.parts < chunks && out.parts < 16 && blocks.width * blocks.height * out.parts < kEnough) out.parts *= 2;
  out.blocks_x = std::min(kAroundBlocksX, kAroundGroup / out.parts);
  out.blocks_y = kAroundGroup / out.parts / out.blocks_x;
  out.count = {(blocks.width + out.blocks_x - 1) / out.blocks_x, (blocks.height + out.blocks_y - 1) / out.blocks_y};
  return out;
}

}  // namespace

Result<MatchAround> MatchAround::make(const Device& device) {
  MatchAround out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"match around", kMatchAroundCode, 6, sizeof(MatchAroundPush)}));
  return out;
}

void MatchAround::record(Recorder& recorder, const Input& in, BufferView<std::int16_t> dst, Size size) const {
  const bool whole_row = in.coarser.absent(), masked = !in.left_inside.absent();
  DUO_CHECK(in.left.holds(size) && in.right.holds(size) && dst.holds(size));
  DUO_CHECK(whole_row || in.coarser.holds({(size.width + 1) / 2, (size.height + 1) / 2}));
  DUO_CHECK(masked ? in.left_inside.holds(size) && in.right_inside.holds(size) : in.right_inside.absent());
  DUO_CHECK(whole_row ? size.width < (1 << 16) : in.radius >= 0 && in.radius < (1 << 15));  // candidates are counted in 16 bits
  const Groups groups = groups_of(size, whole_row ? size.width + 1 : 2 * in.radius + 1);
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
                             masked,
                             groups.blocks_x,
                             groups.blocks_y,
                             groups.parts};
  // Every binding needs a buffer; the kernel does not look at those that stand in for absent ones.
  const auto present = [&](const auto& view) { return view.absent() ? reads(in.left) : reads(view); };
  recorder.dispatch(
      kernel_, push,
      {reads(in.left), reads(in.right), present(in.left_inside), present(in.right_inside), present(in.coarser), writes(dst)},
      groups.count);
}

}  // namespace duo::vk
