// What the thesis tracker observes on a device: the same joints as in the maps on the CPU.

#include "trackers/thesis/observe_joints_vk.h"
#include "tests/agree_vk.h"
#include "tests/targets.h"
#include "trackers/thesis/map_observer.h"

namespace duo {
namespace {

constexpr Size kSize{241, 150};

/// Six textured discs, each of a hue and a disparity of its own, before a gray wall.
struct Scene {
  Frame frame;
  std::array<Pixel, kMaxTargets> at;

  explicit Scene(int moved_px) {
    Image<Rgb8>& color = frame.color = Image<Rgb8>(kSize);
    Image<std::uint8_t>& gray = frame.left = Image<std::uint8_t>(kSize);
    Image<std::uint16_t>& d_q4 = frame.disparity.d_q4 = Image<std::uint16_t>(kSize);
    std::mt19937 rng(20);
    unsigned texture[kMaxTargets][7][7];
    for (auto& disc : texture)
      for (auto& row : disc)
        for (unsigned& patch : row) patch = rng() % 120;
    for (int t = 0; t < kMaxTargets; ++t) at[t] = {40 + 70 * (t / 3), 40 + 80 * (t % 3) + moved_px};
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        color.at(y, x) = {90, 90, 90};
        d_q4.at(y, x) = rng() % 6 == 0 ? Disparity::kNone : 160;
        for (int t = 0; t < kMaxTargets; ++t) {
          if (!Disc{at[t].x, at[t].y, 16}.contains(y, x)) continue;
          const int u = x - at[t].x, v = y - at[t].y;
          const auto light = static_cast<std::uint8_t>(120 + texture[t][(v + 16) / 5][(u + 16) / 5]);
          const auto dark = static_cast<std::uint8_t>(light / 4);
          color.at(y, x) = {t % 3 == 0 ? light : dark, t % 3 == 1 || t == 3 ? light : dark,
                            t % 3 == 2 || t == 4 ? light : dark};
          d_q4.at(y, x) = static_cast<std::uint16_t>(400 + 20 * t + static_cast<int>(rng() % 5));
        }
        const auto [r, g, b] = color.at(y, x);
        gray.at(y, x) = static_cast<std::uint8_t>((r + g + b) / 3);
      }
  }
};

/// The joints of `clicks`, as learnt from a frame.
Expectation learnt(thesis::MapObserver& observer, const Frame& frame, std::span<const Pixel> clicks) {
  Expectation out;
  auto points = std::make_shared<std::vector<JointPoints>>();
  observer.begin(frame);
  for (const Pixel& p : clicks) {
    ExpectedJoint& joint = out.joints[static_cast<std::size_t>(out.count++)];
    joint.at = {16 * p.x, 16 * p.y};
    joint.target = thesis::blob_target(observer.hue_at(p).value(), thesis::joint_window(kSize, joint.at));
    points->push_back(observer.points_around(joint.at));
  }
  out.points = std::move(points);
  return out;
}

TEST(ObserveVk, SeesWhatTheCpuSees) {
  if (test::assisted()) GTEST_SKIP() << "each of its kernels is checked alone";
  test::each_device([&](vk::Device& device, const std::string& where) {
    auto joints = test::must(vk::ObserveJoints::make(device, kSize));
    thesis::MapObserver on_cpu(kSize);
    auto points = test::must(vk::Recorder::make(device)), look = test::must(vk::Recorder::make(device));
    points.begin();
    joints.record_points(points);
    test::must(points.end());
    const Scene first(0);
    int by_points = 0;
    for (const std::size_t count : {std::size_t{3}, first.at.size(), std::size_t{1}}) {
      const Expectation expected = learnt(on_cpu, first.frame, {first.at.data(), count});
      bool new_points = true;
      for (const int moved_px : {0, 3, 40}) {
        const Scene scene(moved_px);
        const test::OnDevice<Rgb8> color(device, scene.frame.color, "color");
        const test::OnDevice<std::uint8_t> left(device, scene.frame.left, "left");
        const test::OnDevice<std::uint16_t> d(device, scene.frame.disparity.d_q4, "disparity");
        look.begin();
        color.record_upload(look);
        left.record_upload(look);
        d.record_upload(look);
        joints.record(look, {color.view(), left.view(), d.view()});
        test::must(look.end());
        ASSERT_EQ(joints.expect(expected), new_points);
        if (new_points) test::must(points.run());
        new_points = false;
        test::must(look.run());
        Observation got, want;
        joints.read(got);
        on_cpu.begin(scene.frame);
        on_cpu.observe(expected, want);
        for (std::size_t i = 0; i < count; ++i) {
          const std::string what = where + ", joint " + std::to_string(i) + " moved by " + std::to_string(moved_px);
          EXPECT_EQ(got.colors[i], want.colors[i]) << what;
          EXPECT_EQ(got.joints[i].seen_by, want.joints[i].seen_by) << what;
          // Points may differ in their last bits.
          EXPECT_NEAR(got.joints[i].at.x, want.joints[i].at.x, 1) << what;
          EXPECT_NEAR(got.joints[i].at.y, want.joints[i].at.y, 1) << what;
          if (got.joints[i].at == want.joints[i].at) {
            EXPECT_EQ(got.joints[i].d_q4, want.joints[i].d_q4) << what;
          }
          EXPECT_EQ(want.joints[i].seen_by & kSeenByColor, moved_px < 40 ? kSeenByColor : 0u) << what << ": the scene itself";
          by_points += (want.joints[i].seen_by & kSeenByPoints) != 0;
        }
        if (testing::Test::HasFailure()) return;
      }
    }
    EXPECT_GT(by_points, 8) << "of 20: the scene itself";
  });
}

}  // namespace
}  // namespace duo
