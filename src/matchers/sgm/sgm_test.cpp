#include "matchers/sgm/sgm.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "tests/agree.h"
#include "tests/allocations.h"

namespace duo {
namespace {

/// A textured wall at 4 px with a box at 12 px in front of its middle third; the right camera is darker and has less contrast.
struct BoxScene {
  Image<std::uint8_t> left, right;
  /// `levels`: of the texture; three are no noise.
  explicit BoxScene(Size size, int levels = 256) : left(size), right(size) {
    std::mt19937 rng(21);
    Image<std::uint8_t> texture({size.width + 64, size.height});
    test::fill(texture.view(), test::Fill::kRandom, rng);
    for (int y = 0; y < texture.height(); ++y)
      for (int x = 0; x < texture.width(); ++x)
        if (levels < 256) texture.at(y, x) = static_cast<std::uint8_t>(100 + texture.at(y, x) % levels);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        left.at(y, x) = texture.at(y, x);
        right.at(y, x) =
            static_cast<std::uint8_t>(texture.at(y, x + (x * 3 > size.width && x * 3 < 2 * size.width ? 12 : 4)) * 7 / 10);
      }
  }
};

void expect_engines_agree(Size size, int max_disparity, int paths, bool masked, int clear = 1, int coding_noise_q4 = 0) {
  const BoxScene scene(size, coding_noise_q4 > 0 ? 3 : 256);
  const SgmParams params = *sgm_params("default", {{"paths", paths}, {"clear", clear}, {"refine", masked}});
  Image<std::uint8_t> inside = test::constant<std::uint8_t>(size, 255);
  for (int y = 0; y < size.height; ++y) inside.at(y, 0) = 0;
  GrayPair pair{scene.left, scene.right};
  pair.coding_noise_q4 = coding_noise_q4;
  if (masked) pair.left_inside = inside, pair.right_inside = inside;
  MatchSetup setup{size, max_disparity, masked};
  setup.denoised = masked;
  StageTimer timer;
  Image<std::uint16_t> want(size);
  Image<std::uint8_t> sure(size);
  ref::Sgm(params, setup).match(pair, {want, sure}, timer);
  // One thread and one number of several, which differs from case to case: starting threads takes longer than the work.
  const int several = 2 + (max_disparity + paths + clear + (masked ? 1 : 0)) % 4;
  test::each_target([&](const std::string& target) {
    for (const int threads : {1, several}) {
      Pool pool(threads);
      Image<std::uint16_t> got(size);
      simd::Sgm matcher(pool, params, setup);
      for (int frame = 0; frame < 2; ++frame) {  // a second frame must not see anything of the first
        Image<std::uint8_t> got_sure(size);
        matcher.match(pair, {got, got_sure}, timer);
        test::expect_same<std::uint8_t>(sure, got_sure, "sgm confidence " + target);
        test::expect_same<std::uint16_t>(want, got, "sgm simd " + target + " threads " + std::to_string(threads));
      }
    }
  });
}

TEST(Sgm, RowsBetweenThoseThatWereMatched) {
  constexpr std::uint16_t kNone = Disparity::kNone;
  // One surface, its limit, two surfaces by gray, a hole that is closer and one that is not, two holes, equal grays.
  const std::array<std::uint16_t, 8> upper = {160, 160, 160, 160, kNone, kNone, kNone, 160},
                                     lower = {163, 176, 177, 400, 160, 160, kNone, 400};
  const std::array<std::uint8_t, 8> gray[3] = {
      {0, 0, 10, 10, 10, 10, 0, 10}, {0, 0, 20, 90, 20, 90, 0, 20}, {0, 0, 99, 99, 99, 99, 0, 30}};
  const std::array<std::uint16_t, 8> want = {162, 168, 160, 400, kNone, 160, kNone, 160};
  const std::array<std::uint8_t, 8> want_sure = {3, 3, 7, 3, 7, 3, 3, 7};
  Image<std::uint16_t> d({8, 4});
  Image<std::uint8_t> sure({8, 4}), guide({8, 4});
  std::ranges::copy(upper, d.row(0));
  std::ranges::copy(lower, d.row(2));
  std::fill_n(sure.row(0), 8, std::uint8_t{7});
  std::fill_n(sure.row(2), 8, std::uint8_t{3});
  for (int y = 0; y < 3; ++y) std::ranges::copy(gray[y], guide.row(y));
  for (const int y : {1, 3}) fill_between(guide, 2, y, {d, sure});
  for (int x = 0; x < 8; ++x) {
    EXPECT_EQ(d.at(1, x), want[static_cast<std::size_t>(x)]) << x;
    EXPECT_EQ(sure.at(1, x), want_sure[static_cast<std::size_t>(x)]) << x;
    EXPECT_EQ(d.at(3, x), lower[static_cast<std::size_t>(x)]) << x;  // nothing was matched below
    EXPECT_EQ(sure.at(3, x), 3) << x;
  }
}

TEST(Sgm, TheLastFractionAndEvenPenaltiesAreOfPicturesThatWereRaw) {
  const Size size{90, 40};
  const BoxScene scene(size);
  const Image<std::uint8_t> inside = test::constant<std::uint8_t>(size, 255);
  StageTimer timer;
  const auto matched_by = [&](const Overrides& overrides, bool masked) {
    GrayPair pair{scene.left, scene.right};
    if (masked) pair.left_inside = inside, pair.right_inside = inside;
    Image<std::uint16_t> out(size);
    MatchSetup setup{size, 20, masked};
    setup.denoised = masked;
    ref::Sgm(*sgm_params("default", overrides), setup).match(pair, {out}, timer);
    return out;
  };
  const auto same = [](const Image<std::uint16_t>& a, const Image<std::uint16_t>& b) {
    for (int y = 0; y < a.height(); ++y)
      if (!std::equal(a.row(y), a.row(y) + a.width(), b.row(y))) return false;
    return true;
  };
  for (const char* name : {"refine", "even"}) {
    const auto matched = [&](int value, bool masked, int clear = 0) {
      return matched_by({{"refine", 0}, {"even", 0}, {name, value}, {"clear", clear}}, masked);
    };
    const Image<std::uint16_t> without = matched(0, true), with = matched(2, true);
    EXPECT_FALSE(same(without, with)) << name;
    EXPECT_TRUE(same(matched(1, true), with)) << name;
    EXPECT_TRUE(same(matched(1, false), matched(0, false))) << name;
    EXPECT_FALSE(same(matched(2, false), matched(0, false))) << name;
    EXPECT_TRUE(same(matched(2, true, 2), matched(0, true, 2))) << name;  // clear pictures
  }
  EXPECT_TRUE(same(matched_by({{"even", 2}, {"clear", 0}}, false), matched_by({{"p2-least", 40}, {"clear", 0}}, false)));
}

// By hand (stages/types/noise.h): of 15 sixteenths of coding noise 15 (15 - 10) / 10 = 7.5 count, of 24 all, of 10 nothing. The
// picture's own noise counts where it is more; noise of either kind is not clear.
TEST(Sgm, NoiseIsAtLeastThatOfTheCoding) {
  const Size size{64, 40};
  Image<std::uint8_t> fine(size), noisy(size);
  std::mt19937 rng(5);
  test::fill(noisy.view(), test::Fill::kRandom, rng);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      fine.at(y, x) = static_cast<std::uint8_t>(100 + x + y),
                 noisy.at(y, x) = static_cast<std::uint8_t>(noisy.at(y, x) / 2 + 50);
  const SgmParams params = *sgm_params("default", {});
  StageTimer timer;
  Pool pool(1);
  const auto measured = [&](const Image<std::uint8_t>& picture, int coding_noise_q4) {
    GrayPair pair{picture, picture};
    pair.coding_noise_q4 = coding_noise_q4;
    const Measured of_ref = ref::Sgm(params, {size, 16, false}).measure(pair, timer);
    const Measured of_simd = simd::Sgm(pool, params, {size, 16, false}).measure(pair, timer);
    EXPECT_EQ(of_ref.noise_q4, of_simd.noise_q4);
    EXPECT_EQ(of_ref.clear, of_simd.clear);
    return std::pair(of_ref.noise_q4, of_ref.clear);
  };
  EXPECT_EQ(measured(fine, 0).first, 0);
  EXPECT_EQ(measured(fine, 10), measured(fine, 0));
  EXPECT_EQ(measured(fine, 15), std::pair(7, false));
  EXPECT_EQ(measured(fine, 24), std::pair(24, false));
  const int own = measured(noisy, 0).first;
  EXPECT_GT(own, 40);
  EXPECT_EQ(measured(noisy, 40).first, own);
}

// By hand: of 100, where nothing changes 100; beside a step of a pixel 1600 / 32 = 50; beside one of five pixels, of which
// three count, 1600 / 64 = 25. Three columns away a step still counts, four away not; holes are passed over, and have 0.
TEST(Sgm, ConfidenceIsLessBesideSteps) {
  EXPECT_EQ(confidence_of(100, 0), 100);
  EXPECT_EQ(confidence_of(0, 0), 1);
  Image<std::uint16_t> d_q4 = test::constant<std::uint16_t>({12, 1}, 32);
  d_q4.at(0, 4) = 48, d_q4.at(0, 10) = 112;
  for (const int hole : {7, 8}) d_q4.at(0, hole) = Disparity::kNone;
  Image<std::uint8_t> confidence = test::constant<std::uint8_t>(d_q4.size(), 100);
  Image<std::uint16_t> columns({12, 2});
  keep_confidence(d_q4, 0, columns, confidence);
  const int want[] = {100, 50, 50, 50, 50, 50, 50, 0, 0, 25, 25, 25};
  for (int x = 0; x < 12; ++x) EXPECT_EQ(confidence.at(0, x), want[x]) << x;
}

// With paths from below there is a volume of a byte for each pixel and disparity; all else together is half of that at most.
TEST(Sgm, MemoryIsOneAndAHalfBytesACellAtMost) {
  for (const Size size : {Size{640, 480}, Size{1280, 720}}) {
    Pool pool(2);
    const MatchSetup setup{size, 128, true};
    const long before = test::allocated_bytes;
    const simd::Sgm matcher(pool, *sgm_params("paths8", {}), setup);
    const double cells = double(size.width) * size.height * setup.max_disparity;
    const double bytes = static_cast<double>(test::allocated_bytes - before) / cells;
    EXPECT_GT(bytes, 1) << "the counter itself works";
    EXPECT_LT(bytes, 1.5) << size.width;
    std::printf("%dx%d: %.2f bytes a cell\n", size.width, size.height, bytes);
  }
}

TEST(Sgm, EnginesAgree) {
  for (const int paths : {3, 4, 5, 8})
    for (const bool masked : {false, true}) {
      expect_engines_agree({90, 30}, 20, paths, masked);
      if (HasFailure()) return;
    }
  expect_engines_agree({33, 17}, 70, 3, true);
  for (const int clear : {0, 2}) expect_engines_agree({90, 30}, 20, 3, true, clear);
  for (const int coding_noise_q4 : {24, 70}) expect_engines_agree({90, 30}, 20, 3, true, 1, coding_noise_q4);
  // Vectors that are all used, behind one that holds nothing.
  for (const int paths : {3, 8})
    for (const int max_disparity : {16, 32, 48, 96}) expect_engines_agree({70, 12}, max_disparity, paths, false);
  expect_engines_agree({1, 1}, 1, 8, true);
  expect_engines_agree({5, 12}, 3, 3, false);
}

TEST(Sgm, FindsWallAndBoxInADarkerPicture) {
  const Size size{150, 60};
  const BoxScene scene(size);
  Image<std::uint16_t> d_q4(size);
  StageTimer timer;
  Pool pool(1);
  simd::Sgm(pool, *sgm_params("default", {}), {size, 32, false}).match({scene.left, scene.right}, {d_q4}, timer);
  int right = 0, wrong = 0;
  for (int y = 0; y < size.height; ++y)
    for (int x = 20; x < size.width - 8; ++x) {
      if (d_q4.at(y, x) == Disparity::kNone) continue;
      const int d = (d_q4.at(y, x) + 8) / 16;
      (d == 4 || d == 12 ? right : wrong) += 1;
    }
  EXPECT_GT(right, 60 * 90);
  EXPECT_LT(wrong, right / 100);
}

/// A wall with little texture at 9 px, seen with white noise of `sigma` gray levels.
struct NoisyWall {
  static constexpr int kAt_px = 9;
  Image<std::uint8_t> left, right;
  NoisyWall(Size size, double sigma) : left(size), right(size) {
    std::mt19937 rng(4);
    std::normal_distribution<double> noise(0, 1);
    const auto value = [&](int y, int x) {
      const double texture =
          5 * std::sin(0.35 * x + 0.2 * y) + 4 * std::sin(0.13 * x * (1 + 0.01 * y)) + 3 * std::sin(0.31 * y);
      return static_cast<std::uint8_t>(std::lround(120 + texture + sigma * noise(rng)));
    };
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) left.at(y, x) = value(y, x), right.at(y, x) = value(y, x + kAt_px);
  }
  /// Pixels found within one.
  int right_ones(bool soften) const {
    Image<std::uint16_t> d_q4(left.size());
    StageTimer timer;
    Pool pool(1);
    simd::Sgm(pool, *sgm_params("default", {{"soften", soften}}), {left.size(), 32, false}).match({left, right}, {d_q4}, timer);
    int found = 0;
    for (int y = 0; y < left.height(); ++y)
      for (int x = kAt_px; x < left.width(); ++x)
        found += d_q4.at(y, x) != Disparity::kNone && std::abs(d_q4.at(y, x) - 16 * kAt_px) <= 16;
    return found;
  }
};

TEST(Sgm, FindsMoreInNoiseWhenItSoftens) {
  const Size size{160, 120};
  EXPECT_EQ(NoisyWall(size, 0).right_ones(true), NoisyWall(size, 0).right_ones(false));
  const NoisyWall noisy(size, 5);
  const int softened = noisy.right_ones(true), as_it_is = noisy.right_ones(false);
  std::printf("noise of 5 levels: %d of %d pixels, %d without softening\n", softened,
              size.height * (size.width - NoisyWall::kAt_px), as_it_is);
  EXPECT_GT(softened, as_it_is * 5 / 4);
}

// A plane whose disparity rises by one pixel in 25 columns: every fraction must be as frequent as any other.
TEST(Sgm, SubPixelIsNotDrawnToWholePixels) {
  const Size size{440, 60};
  std::mt19937 rng(9);
  // Texture from smoothed noise at four times the resolution, so that it can be read between pixels.
  constexpr int kFine = 4;
  const int n = (size.width + 64) * kFine;
  Image<std::uint8_t> left(size), right(size);
  std::vector<float> noise(static_cast<std::size_t>(n)), smooth(static_cast<std::size_t>(n));
  for (int y = 0; y < size.height; ++y) {
    for (float& v : noise) v = static_cast<float>(rng() % 256);
    for (int i = 0; i < n; ++i) {
      float sum = 0, weight = 0;
      for (int k = -6; k <= 6; ++k)
        if (i + k >= 0 && i + k < n)
          sum += noise[static_cast<std::size_t>(i + k)] * static_cast<float>(7 - std::abs(k)),
              weight += static_cast<float>(7 - std::abs(k));
      smooth[static_cast<std::size_t>(i)] = 128 + 3 * (sum / weight - 128);
    }
    const auto at = [&](double x) {
      const double p = std::clamp((x + 32) * kFine, 0.0, n - 2.0);
      const int i = static_cast<int>(p);
      return static_cast<std::uint8_t>(
          std::clamp(smooth[static_cast<std::size_t>(i)] +
                         (p - i) * (smooth[static_cast<std::size_t>(i) + 1] - smooth[static_cast<std::size_t>(i)]) + 0.5,
                     0.0, 255.0));
    };
    for (int x = 0; x < size.width; ++x) {
      right.at(y, x) = at(x);
      left.at(y, x) = at((x - 4) / 1.04);  // x_right = x - d, d = 4 + 0.04 x_right
    }
  }
  Image<std::uint16_t> d_q4(size);
  StageTimer timer;
  Pool pool(1);
  simd::Sgm(pool, *sgm_params("default", {}), {size, 32, false}).match({left, right}, {d_q4}, timer);
  int histogram[16] = {}, count = 0;
  double error = 0;
  for (int y = 0; y < size.height; ++y)
    for (int x = 30; x < 430; ++x) {
      if (d_q4.at(y, x) == Disparity::kNone) continue;
      ++histogram[d_q4.at(y, x) % 16];
      ++count;
      error += std::abs(d_q4.at(y, x) / 16.0 - (x - (x - 4) / 1.04));
    }
  EXPECT_GT(count, 60 * 400 * 9 / 10);
  EXPECT_LT(error / count, 0.15);
  for (int f = 0; f < 16; ++f) {
    EXPECT_GT(histogram[f], count / 16 / 3) << f;
    EXPECT_LT(histogram[f], count / 16 * 2) << f;
  }
}

TEST(Sgm, ParametersAreChecked) {
  EXPECT_TRUE(sgm_params("default", {}));
  EXPECT_TRUE(sgm_params("paths8", {{"paths", 5}}));
  EXPECT_FALSE(sgm_params("other", {}));
  EXPECT_FALSE(sgm_params("default", {{"paths", 6}}));
  EXPECT_FALSE(sgm_params("default", {{"p1", 30}}));
  EXPECT_FALSE(sgm_params("default", {{"p2", 10}}));
  EXPECT_FALSE(sgm_params("default", {{"p2", 113}}));
  EXPECT_FALSE(sgm_params("default", {{"window", 1}}));
}

}  // namespace
}  // namespace duo
