#include "trackers/thesis/place_joints_vk.h"

#include "trackers/thesis/place_joints_params.h"

namespace duo::vk {
namespace {

constexpr std::uint32_t kPlaceJointsCode[] = {
#include "spirv/place_joints.comp.inc"
};
// The kernel takes them as they are.
static_assert(sizeof(PlaceQ4) == 8 && sizeof(ObservedJoint) == 16 && sizeof(AreaSums) == 96);
static_assert(kPlaceJointsVotes == JointPoints::kCapacity);

}  // namespace

Result<PlaceJoints> PlaceJoints::make(const Device& device) {
  PlaceJoints out;
  DUO_TRY_ASSIGN(out.kernel_, Kernel::make(device, {"place joints", kPlaceJointsCode, 7, sizeof(PlaceJointsPush)}));
  return out;
}

void PlaceJoints::record(Recorder& recorder, const Input& in, const Buffer& joints, Size size) const {
  const SiftListShape &stored = in.stored_shape, &seen = in.seen_shape;
  const auto lists = static_cast<std::size_t>(stored.lists), places = lists * static_cast<std::size_t>(stored.capacity);
  DUO_CHECK(stored.lists == seen.lists && stored.capacity <= kPlaceJointsVotes && in.d_q4.holds(size));
  DUO_CHECK(in.expected->bytes() >= lists * sizeof(PlaceQ4) && in.colors->bytes() >= lists * sizeof(AreaSums));
  DUO_CHECK(in.seen->bytes() >= sift_list_bytes(seen) && in.matches->bytes() >= places * sizeof(PointMatch));
  DUO_CHECK(in.to_joint->bytes() >= places * sizeof(PlaceQ4) && joints.bytes() >= lists * sizeof(ObservedJoint));
  const PlaceJointsPush push{stored, seen, in.d_q4.plane, size.width, size.height, kLeastBlobPixels, kLeastVotes};
  recorder.dispatch(kernel_, push,
                    {reads(*in.expected), reads(*in.colors), reads(*in.seen), reads(*in.matches), reads(*in.to_joint),
                     reads(in.d_q4), writes(joints)},
                    {stored.lists, 1});
}

}  // namespace duo::vk
