#include "stages/tile_candidates/tile_candidates_vk.h"

#include "stages/tile_candidates/tile_candidates_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kTileCandidatesCode[] = {
#include "spirv/tile_candidates.comp.inc"
};

}  // namespace

Result<TileCandidates> TileCandidates::make(const Device& device) {
  TileCandidates out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"tile candidates", kTileCandidatesCode, 3, sizeof(TileCandidatesPush)}));
  return out;
}

void TileCandidates::record(Recorder& recorder, const Input& in, BufferView<std::uint32_t> sets, Size size,
                            int max_disparity) const {
  const Size coarse{(size.width + 1) / 2, (size.height + 1) / 2}, shape = TileSets::shape32(size, max_disparity);
  DUO_CHECK(in.checked.holds(coarse) && in.unchecked.holds(coarse) && sets.holds(shape));
  DUO_CHECK(shape.width <= kCandidatesMaxWords && in.grow >= 0 && in.margin >= 0 && 2 * in.margin + 2 <= 32);
  const TileCandidatesPush push{in.checked.plane,     in.unchecked.plane,    sets.plane,    coarse.width, coarse.height,
                                TileSets::kWidth / 2, TileSets::kHeight / 2, max_disparity, in.grow,      in.margin};
  recorder.dispatch(kernel_, push, {reads(in.checked), reads(in.unchecked), writes(sets)}, TileSets::tiles_of(size));
}

}  // namespace duo::vk
