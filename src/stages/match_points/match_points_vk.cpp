#include "stages/match_points/match_points_vk.h"

#include "stages/match_points/match_points_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kMatchPointsCode[] = {
#include "spirv/match_points.comp.inc"
};
static_assert(sizeof(PointMatch) == 8 && sizeof(PredictedPlace) == 8);  // the kernel takes them as they are

}  // namespace

Result<MatchPoints> MatchPoints::make(const Device& device) {
  MatchPoints out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"match points", kMatchPointsCode, 4, sizeof(MatchPointsPush)}));
  return out;
}

void MatchPoints::record(Recorder& recorder, const Input& in, const MatchPointsParams& params, const Buffer& matches) const {
  const SiftListShape &stored = in.stored_shape, &seen = in.seen_shape;
  const auto places = static_cast<std::size_t>(stored.lists) * static_cast<std::size_t>(stored.capacity);
  DUO_CHECK(in.stored != nullptr && in.seen != nullptr && stored.lists == seen.lists);
  DUO_CHECK(in.stored->bytes() >= sift_list_bytes(stored) && in.seen->bytes() >= sift_list_bytes(seen));
  DUO_CHECK(in.predicted == nullptr || in.predicted->bytes() >= places * sizeof(PredictedPlace));
  DUO_CHECK(matches.bytes() >= places * sizeof(PointMatch));
  const auto dispatch = [&](int mutual) {
    const MatchPointsPush push{stored, seen, params.ratio_percent, in.predicted != nullptr, params.reach_px * params.reach_px,
                               mutual};
    recorder.dispatch(
        kernel_, push,
        {reads(*in.stored), reads(*in.seen), reads(in.predicted != nullptr ? *in.predicted : *in.stored), writes(matches)},
        {stored.capacity, stored.lists});
  };
  dispatch(0);
  if (params.mutual) dispatch(1);
}

}  // namespace duo::vk
