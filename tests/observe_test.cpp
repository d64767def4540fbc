// The stages of the thesis's tracker one after the other: a bare forearm and a face of the same hue before a wall of another.

#include "duoptic/frame.h"
#include "stages/erode/erode.h"
#include "stages/hsv/hsv.h"
#include "stages/mark_targets/mark_targets.h"
#include "stages/region/region.h"
#include "stages/sums/sums.h"
#include "tests/agree.h"
#include "tests/allocations.h"
#include "tests/time.h"

namespace duo {
namespace {

constexpr Size kSize{640, 480};
constexpr Pixel kElbow{400, 200};  // one end of the forearm's axis; the other is at (150, 350)

struct Scene {
  Image<Rgb8> color{kSize};
  Image<std::uint16_t> d_q4{kSize};
};

/// Skin and wall with noise; every sixth disparity is missing.
Scene make_scene() {
  Scene out;
  std::mt19937 rng(20);
  const auto noisy = [&](int v) { return static_cast<std::uint8_t>(v + static_cast<int>(rng() % 17) - 8); };
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      // Distance to the axis from (y, x), which leads 150 columns right and 250 rows up.
      const double along =
          std::clamp(((x - kElbow.x) * 150.0 - (y - kElbow.y) * 250.0) / (150.0 * 150 + 250.0 * 250), 0.0, 1.0);
      const double dx = x - kElbow.x - 150 * along, dy = y - kElbow.y + 250 * along;
      const bool arm = dx * dx + dy * dy < 25 * 25, face = Disc{150, 100, 45}.contains(y, x);
      const int light = x / 16;
      if (arm || face)
        out.color.at(y, x) = {noisy(200 + light), noisy(140), noisy(110)};
      else
        out.color.at(y, x) = {noisy(70), noisy(90), noisy(150 + light)};
      const int d = arm ? 420 : face ? 330 : 160;
      out.d_q4.at(y, x) = static_cast<std::uint16_t>(rng() % 6 == 0 ? Disparity::kNone : d + rng() % 5);
    }
  return out;
}

struct Observation {
  AreaSums sums;
  RegionLabel region;
  friend bool operator==(const Observation&, const Observation&) = default;
};

/// All that a frame needs, on pictures that stay.
struct Chain {
  Image<std::uint8_t> hue{kSize}, saturation{kSize}, value{kSize}, marks{kSize}, eroded{kSize};
  RunForestScratch scratch{kSize};
  std::vector<Target> targets{{{12, 12, 40, 40}, Window::all(kSize)}};  // skin

  HsvPlanes planes() { return {hue, saturation, value}; }
  MarkTargets marking() const { return {hue, saturation, value, targets}; }
  Region region() const { return {0, targets[0].window, kElbow}; }
  Area area() const { return {targets[0].window, {}, eroded, 1}; }

  Observation observe(Pool& pool, const Scene& scene) {
    simd::hsv(pool, scene.color, planes());
    simd::mark_targets(pool, marking(), marks);
    simd::erode(pool, marks, Neighbours::kFour, eroded);
    Observation out;
    out.region = simd::keep_region(pool, region(), eroded, scratch);
    out.sums = simd::sums(pool, {kSize, area(), hue, scene.d_q4});
    return out;
  }

  Observation observe_ref(const Scene& scene) {
    ref::hsv(scene.color, planes());
    ref::mark_targets(marking(), marks);
    ref::erode(marks, Neighbours::kFour, eroded);
    Observation out;
    out.region = ref::keep_region(region(), eroded);
    out.sums = ref::sums({kSize, area(), hue, scene.d_q4});
    return out;
  }
};

TEST(Observe, FindsTheForearm) {
  const Scene scene = make_scene();
  Chain chain;
  Pool one(1);
  const Observation seen = chain.observe(one, scene);
  ASSERT_GT(seen.sums.count, 3000);
  EXPECT_NEAR(static_cast<double>(seen.sums.d_q4) / static_cast<double>(seen.sums.known), 422, 1) << "not the face's";
  EXPECT_NEAR(static_cast<double>(seen.sums.x) / static_cast<double>(seen.sums.count), 275, 12);
  EXPECT_NEAR(static_cast<double>(seen.sums.y) / static_cast<double>(seen.sums.count), 275, 20);
  EXPECT_NEAR(*mean_hue(seen.sums), 12, 3);
}

TEST(Observe, EnginesAndThreadsAgree) {
  const Scene scene = make_scene();
  Chain chain;
  const Observation want = chain.observe_ref(scene);
  for (const int threads : {1, 2, 3}) {
    Pool pool(threads);
    test::each_target(
        [&](const std::string& target) { EXPECT_EQ(chain.observe(pool, scene), want) << target << " threads " << threads; });
  }
}

TEST(Observe, DoesNotAllocate) {
  const Scene scene = make_scene();
  Chain chain;
  Pool two(2);
  chain.observe(two, scene);
  const long before = test::allocations.load();
  chain.observe(two, scene);
  EXPECT_EQ(test::allocations.load(), before);
}

TEST(Observe, Time) {
  const Scene scene = make_scene();
  Chain chain;
  Pool one(1);
  test::print_time("all stages, 1 target", kSize, [&] { chain.observe(one, scene); });
  chain.targets[0].window = {180, 120, 200, 320};
  test::print_time("all stages, 1 target, 200x320", kSize, [&] { chain.observe(one, scene); });
}

}  // namespace
}  // namespace duo
