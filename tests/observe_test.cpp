// The observation stages one after the other, as a tracker uses them: a bare forearm before a wall of the same hue.

#include "stages/erode/erode.h"
#include "stages/histogram/histogram.h"
#include "stages/hsv/hsv.h"
#include "stages/mark_targets/mark_targets.h"
#include "stages/region/region.h"
#include "stages/sample_depth/sample_depth.h"
#include "stages/sums/sums.h"
#include "tests/agree.h"
#include "tests/allocations.h"
#include "tests/time.h"

namespace duo {
namespace {

constexpr Size kSize{640, 480};
constexpr Pixel kElbow{400, 200}, kTip{150, 350};  // of the forearm's axis
constexpr Pixel kFace{100, 150};

struct Scene {
  Image<Rgb8> color{kSize};
  Image<std::uint16_t> d_q4{kSize};
};

/// Skin, wall and shirt with noise; every sixth disparity is missing, some are the wall's.
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
      const bool arm = dx * dx + dy * dy < 25 * 25;
      const bool face = Disc{kFace.x, kFace.y, 45}.contains(y, x), shirt = x < 220 && y > 200;
      const int light = x / 16;
      if (arm || face)
        out.color.at(y, x) = {noisy(200 + light), noisy(140), noisy(110)};
      else if (shirt)
        out.color.at(y, x) = {noisy(70), noisy(90), noisy(150)};
      else
        out.color.at(y, x) = {noisy(170 + light), noisy(120), noisy(95)};
      const int d = arm ? 420 : face || shirt ? 330 : 160;
      out.d_q4.at(y, x) = static_cast<std::uint16_t>(rng() % 6 == 0 ? Disparity::kNone : rng() % 12 == 0 ? 160 : d + rng() % 5);
    }
  return out;
}

struct Observation {
  AreaSums sums;
  DepthSample depth;
  RegionLabel region;
  Pixel tip;
  friend bool operator==(const Observation&, const Observation&) = default;
};

/// All that a frame needs, on pictures that stay.
struct Chain {
  Image<std::uint8_t> hue{kSize}, saturation{kSize}, value{kSize}, marks{kSize}, eroded{kSize};
  RunForestScratch scratch{kSize};
  std::vector<ColorLikelihood> likelihoods = std::vector<ColorLikelihood>(1);
  std::vector<Target> targets;

  HsvPlanes planes() { return {hue, saturation, value}; }
  MarkTargets marking(const Scene& scene) const { return {hue, saturation, value, scene.d_q4, {}, targets, likelihoods}; }
  Region region() const { return {0, targets[0].window, Region::Pick::kNearest, kElbow}; }
  Area area() const { return {targets[0].window, {}, eroded, 1}; }
  ColorCount count(Area of) const { return {hue, saturation, value, of, 30}; }

  void learn(Pool& pool, const Scene& scene) {
    simd::hsv(pool, scene.color, planes());
    const auto skin = simd::color_histogram(pool, count({Window::all(kSize), {kElbow.x, kElbow.y, 15}}));
    const auto cloth = simd::color_histogram(pool, count({{20, 250, 120, 200}}));
    likelihoods[0] = likelihood_of(smoothed(skin), smoothed(cloth));
    Target target;
    target.color.likelihood = 0;
    target.gate = {380, 460, -1, true};
    target.window = Window::all(kSize);
    targets.assign(1, target);
  }

  Observation observe(Pool& pool, const Scene& scene) {
    simd::hsv(pool, scene.color, planes());
    simd::mark_targets(pool, marking(scene), marks);
    simd::erode(pool, marks, Neighbours::kFour, eroded);
    Observation out;
    out.region = simd::keep_region(pool, region(), eroded, scratch);
    out.sums = simd::sums(pool, {kSize, area(), hue, scene.d_q4});
    out.depth = simd::sample_depth(pool, scene.d_q4, area());
    out.tip = simd::farthest_pixel(pool, kSize, area(), kElbow);
    return out;
  }

  Observation observe_ref(const Scene& scene) {
    ref::hsv(scene.color, planes());
    ref::mark_targets(marking(scene), marks);
    ref::erode(marks, Neighbours::kFour, eroded);
    Observation out;
    out.region = ref::keep_region(region(), eroded);
    out.sums = ref::sums({kSize, area(), hue, scene.d_q4});
    out.depth = ref::sample_depth(scene.d_q4, area());
    out.tip = ref::farthest_pixel(kSize, area(), kElbow);
    return out;
  }
};

// Pictures, tables and targets as they stand once the tracker has learnt the skin.
struct Learned {
  Learned() { chain.learn(one, scene); }
  Scene scene = make_scene();
  Chain chain;
  Pool one{1};
};

TEST(Observe, FindsTheForearm) {
  Learned learned;
  const Scene& scene = learned.scene;
  Chain& chain = learned.chain;
  Pool& one = learned.one;
  const Observation seen = chain.observe(one, scene);
  EXPECT_NEAR(seen.depth.median_q4, 422, 3);
  EXPECT_LE(std::abs(seen.tip.x - kTip.x) + std::abs(seen.tip.y - kTip.y), 45) << "the end of a cap of radius 25, eroded";
  ASSERT_GT(seen.sums.count, 3000);
  EXPECT_NEAR(static_cast<double>(seen.sums.x) / static_cast<double>(seen.sums.count), 275, 12);
  EXPECT_NEAR(static_cast<double>(seen.sums.y) / static_cast<double>(seen.sums.count), 275, 20);
  EXPECT_NEAR(*mean_hue(seen.sums), 12, 3);
}

TEST(Observe, EnginesAndThreadsAgree) {
  Learned learned;
  const Scene& scene = learned.scene;
  Chain& chain = learned.chain;
  const Observation want = chain.observe_ref(scene);
  for (const int threads : {1, 2, 3}) {
    Pool pool(threads);
    test::each_target(
        [&](const std::string& target) { EXPECT_EQ(chain.observe(pool, scene), want) << target << " threads " << threads; });
  }
}

TEST(Observe, DoesNotAllocate) {
  Learned learned;
  const Scene& scene = learned.scene;
  Chain& chain = learned.chain;
  Pool two(2);
  chain.observe(two, scene);
  const long before = test::allocations.load();
  chain.observe(two, scene);
  simd::color_histogram(two, chain.count(chain.area()));
  EXPECT_EQ(test::allocations.load(), before);
}

TEST(Observe, Time) {
  Learned learned;
  const Scene& scene = learned.scene;
  Chain& chain = learned.chain;
  Pool& one = learned.one;
  test::print_time("all stages, 1 target", kSize, [&] { chain.observe(one, scene); });
  chain.targets[0].window = {180, 120, 200, 320};
  test::print_time("all stages, 1 target, 200x320", kSize, [&] { chain.observe(one, scene); });
}

}  // namespace
}  // namespace duo
