#include "trackers/thesis/place_joints_vk.h"

#include "tests/records_vk.h"
#include "tests/sift_points.h"
#include "tests/targets.h"

namespace duo {
namespace {

/// What speaks for one joint, and the memory of it.
struct Joint {
  PlaceQ4 expected;
  AreaSums color;
  SiftPoints seen;
  std::vector<PointMatch> matches;
  std::vector<PlaceQ4> to_joint;
  JointEvidence evidence() const { return {expected, &color, &seen, matches, to_joint}; }
};

/// Of `stored` points about half are matched, with many equal votes.
Joint random_joint(int stored, std::mt19937& rng) {
  Joint out;
  const auto within = [&](int most) { return static_cast<int>(rng() % static_cast<unsigned>(most)); };
  out.expected = {within(1600) - 160, within(900) - 160};
  out.color.count = within(3) * (kLeastBlobPixels / 2) + within(2);
  out.color.x = out.color.count * within(120) + within(7);
  out.color.y = out.color.count * (std::int64_t{1} << 20) + within(5);  // far out: sums beyond 32 bits
  if (within(2) == 0) out.color.y = out.color.count * within(50);
  out.seen = test::random_points(40, rng);
  for (int i = 0; i < out.seen.count; ++i) out.seen[i].x_px += static_cast<float>(within(64)) / 32 - 1;
  for (int i = 0; i < stored; ++i) {
    out.matches.push_back({within(2) == 0 ? PointMatch::kNone : within(out.seen.count), within(1000)});
    out.to_joint.push_back({within(400) - 200, within(5) - 2});
  }
  return out;
}

TEST(PlaceJointsVk, Agrees) {
  constexpr Size kSize{101, 47};
  constexpr SiftListShape kStored{5, JointPoints::kCapacity}, kSeen{5, 60};
  constexpr int kPoints[] = {0, 4, 7, 150, JointPoints::kCapacity};
  test::each_device([&](vk::Device& device, const std::string& where) {
    std::mt19937 rng(31);
    const auto stage = test::must(vk::PlaceJoints::make(device));
    auto recorder = test::must(vk::Recorder::make(device));
    Image<std::uint16_t> d(kSize);
    test::fill_disparity(d.view(), rng);
    const test::OnDevice<std::uint16_t> d_vk(device, d, "disparity");
    const test::Records<PlaceQ4> expected(device, 5, "expected"), ways(device, 5 * JointPoints::kCapacity, "ways");
    const test::Records<AreaSums> colors(device, 5, "colors");
    const test::Records<std::byte> seen(device, sift_list_bytes(kSeen), "seen");
    const test::Records<PointMatch> matches(device, 5 * JointPoints::kCapacity, "matches");
    const test::Records<ObservedJoint> joints(device, 5, "joints");
    recorder.begin();
    d_vk.record_upload(recorder);
    expected.record_upload(recorder);
    ways.record_upload(recorder);
    colors.record_upload(recorder);
    seen.record_upload(recorder);
    matches.record_upload(recorder);
    stage.record(
        recorder,
        {&expected.buffer(), &colors.buffer(), &seen.buffer(), &matches.buffer(), &ways.buffer(), kStored, kSeen, d_vk.view()},
        joints.buffer(), kSize);
    joints.record_download(recorder);
    test::must(recorder.end());
    unsigned ways_seen = 0;
    for (int round = 0; round < 12; ++round) {
      std::vector<Joint> all;
      std::memset(matches.bytes().data(), 0xFF, matches.bytes().size());
      for (int i = 0; i < 5; ++i) {
        const Joint& joint = all.emplace_back(random_joint(kPoints[i], rng));
        const auto row = static_cast<std::size_t>(i) * JointPoints::kCapacity;
        const auto put = [](const auto& records, std::size_t at, const auto& values) {
          std::copy(values.begin(), values.end(),
                    reinterpret_cast<std::decay_t<decltype(values[0])>*>(records.bytes().data()) + at);
        };
        put(expected, static_cast<std::size_t>(i), std::span(&joint.expected, 1));
        put(colors, static_cast<std::size_t>(i), std::span(&joint.color, 1));
        put(matches, row, joint.matches);
        put(ways, row, joint.to_joint);
        write_sift_list(joint.seen, kSeen, i, seen.bytes());
      }
      test::must(recorder.run());
      const auto got = joints.read();
      for (std::size_t i = 0; i < 5; ++i) {
        const ObservedJoint want = ref::place_joint(all[i].evidence(), d);
        EXPECT_EQ(got[i], want) << "place_joints" << where << " round " << round << " joint " << i;
        ways_seen |= 1u << want.seen_by;
      }
      if (HasFailure()) return;
    }
    EXPECT_EQ(ways_seen, 15u) << "neither, colour, points, both";
  });
}

}  // namespace
}  // namespace duo
