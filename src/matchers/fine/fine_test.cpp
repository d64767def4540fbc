#include "matchers/fine/fine.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "duoptic/engine.h"
#include "tests/agree.h"

namespace duo {
namespace {

/// A smooth texture on a plane: d = 5 + x / 16 at column x, to a hundredth of a pixel.
struct SlantedPair {
  Pair pair;
  explicit SlantedPair(Size size) {
    std::mt19937 rng(41);
    Image<float> texture({size.width / 2 + 2, size.height / 2 + 2});
    for (int y = 0; y < texture.height(); ++y)
      for (int x = 0; x < texture.width(); ++x) texture.at(y, x) = static_cast<float>(rng() % 200 + 20);
    const auto right_at = [&](int y, double x) {
      const double u = std::clamp(x / 2, 0.0, texture.width() - 1.001), f = u - std::floor(u);
      const int i = static_cast<int>(u), j = y / 2;
      return static_cast<std::uint8_t>(std::lround((1 - f) * texture.at(j, i) + f * texture.at(j, i + 1)));
    };
    pair.left.pixels = Image<Rgb8>(size);
    pair.right.pixels = Image<Rgb8>(size);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const std::uint8_t left = right_at(y, x - disparity(x)), right = right_at(y, x);
        pair.left.pixels.at(y, x) = {left, left, left};
        pair.right.pixels.at(y, x) = {right, right, right};
      }
  }
  static double disparity(int x) { return 5 + x / 16.0; }
};

std::shared_ptr<const Frame> frame_of(const char* engine_name, int threads, const Pair& pair, bool fill, bool color = false) {
  auto engine = make_engine(engine_name, threads);
  duo::Setup setup;
  setup.size = pair.left.pixels.size();
  setup.matcher = "fine";
  setup.max_disparity = 16;
  setup.fill = fill;
  setup.wants.color = color;
  const auto ready = (*engine)->prepare(setup);
  EXPECT_TRUE(ready) << ready.error().what;
  (*engine)->submit(pair);
  return (*engine)->collect();
}

TEST(Fine, FindsASlantedSurface) {
  const SlantedPair scene({96, 32});
  const auto frame = frame_of("simd", 1, scene.pair, true);
  double sum = 0;
  int count = 0;
  for (int y = 4; y < 28; ++y)
    for (int x = 24; x < 80; ++x, ++count) sum += std::abs(frame->disparity.d_q4.at(y, x) / 16.0 - SlantedPair::disparity(x));
  EXPECT_LT(sum / count, 0.12);
  for (int x = 0; x < 96; ++x) EXPECT_NE(frame->disparity.origin.at(9, x), static_cast<std::uint8_t>(Origin::kNone)) << x;
}

TEST(Fine, EnginesAgree) {
  const SlantedPair scene({67, 22});
  for (const bool fill : {false, true}) {
    const auto want = frame_of("ref", 1, scene.pair, fill);
    for (const int threads : {1, 3}) {
      const auto got = frame_of("simd", threads, scene.pair, fill);
      test::expect_same<std::uint16_t>(want->disparity.d_q4, got->disparity.d_q4, "fine, threads " + std::to_string(threads));
      test::expect_same<std::uint8_t>(want->disparity.origin, got->disparity.origin, "origin");
    }
  }
}

// Where one frame is made at a time, whoever waits for it is told; of several at once nobody could say which.
TEST(Fine, TellsHowMuchIsDone) {
  const SlantedPair scene({40, 20});
  const auto told_of = [&](const char* matcher, bool many_at_once) {
    auto engine = make_engine("simd", 2);
    std::vector<double> told;
    duo::Setup setup;
    setup.size = scene.pair.left.pixels.size();
    setup.matcher = matcher;
    setup.max_disparity = 16;
    setup.fill = true;
    setup.many_at_once = many_at_once;
    setup.progress = [&told](double done) { told.push_back(done); };
    EXPECT_TRUE((*engine)->prepare(setup).has_value());
    (*engine)->submit(scene.pair);
    EXPECT_TRUE((*engine)->collect() != nullptr);
    return told;
  };
  const std::vector<double> told = told_of("fine", false);
  ASSERT_GE(told.size(), 4u);
  EXPECT_GT(told.front(), 0);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_DOUBLE_EQ(told.back(), 1);
  EXPECT_TRUE(told_of("fine", true).empty());
  EXPECT_TRUE(told_of("sgm", false).empty());
}

// The picture's own colours serve the matcher, too.
TEST(Fine, ColorsMayBeWantedToo) {
  const SlantedPair scene({40, 20});
  for (const char* name : {"ref", "simd"}) {
    const auto plain = frame_of(name, 1, scene.pair, false), colored = frame_of(name, 1, scene.pair, false, true);
    test::expect_same<std::uint16_t>(plain->disparity.d_q4, colored->disparity.d_q4, name);
    ASSERT_EQ(colored->color.size(), scene.pair.left.pixels.size());
    for (int x = 0; x < 40; ++x) EXPECT_EQ(colored->color.at(7, x), scene.pair.left.pixels.at(7, x));
  }
}

// By hand: planes at 2.5 px lead from column 4 to 4 - 3 = 1, which the mirror has at 6 - 1 - 1 = 4. There 3.5 px agrees within
// 1, 3.6 does not; from column 2 there is no other pixel. Inside pictures take out column 5, and column 3, whose other is 0.
TEST(Fine, ChecksPlanesOfBothViews) {
  PlaneMap left({6, 1}), mirrored({6, 1});
  for (int x = 0; x < 6; ++x) left.set(0, x, {5 * Plane::kOne / 2, 0, 0}), mirrored.set(0, x, {7 * Plane::kOne / 2, 0, 0});
  Image<std::uint16_t> got({6, 1});
  const auto checked = [&](const GrayPair& pair) {
    check_planes(pair, left, mirrored, 1, got);
    return got.clone();
  };
  constexpr int kNo = Disparity::kNone;
  test::expect_same<std::uint16_t>(test::image<std::uint16_t>({{kNo, kNo, kNo, 40, 40, 40}}), checked({}), "all");
  const auto left_inside = test::image<std::uint8_t>({{255, 255, 255, 255, 255, 0}});
  const auto right_inside = test::image<std::uint8_t>({{0, 255, 255, 255, 255, 255}});
  GrayPair masked;
  masked.left_inside = left_inside, masked.right_inside = right_inside;
  test::expect_same<std::uint16_t>(test::image<std::uint16_t>({{kNo, kNo, kNo, kNo, 40, kNo}}), checked(masked), "masked");
  mirrored.set(0, 4, {36 * Plane::kOne / 10, 0, 0});
  test::expect_same<std::uint16_t>(test::image<std::uint16_t>({{kNo, kNo, kNo, 40, kNo, 40}}), checked({}), "too far");
}

// By hand: 2 px lead column 1 out of the right view, and column 2 to its border.
TEST(Fine, WhatTheRightViewDoesNotReachKeepsItsLine) {
  auto voted = test::image<std::uint16_t>({{7, 7, 7, 7}});
  keep_margin(test::image<std::uint16_t>({{1, 32, 32, 49}}), voted);
  test::expect_same<std::uint16_t>(test::image<std::uint16_t>({{1, 32, 7, 49}}), voted, "voted");
}

TEST(Fine, PresetsAndErrors) {
  for (const std::string_view preset : kFinePresets) EXPECT_TRUE(fine_params(preset, {}));
  EXPECT_NE(fine_params("best", {}).error().what.find("choose one of: default, fine"), std::string::npos);
  EXPECT_NE(fine_params("fine", {{"tolerance", 9}}).error().what.find("0 .. 4"), std::string::npos);
  EXPECT_EQ(fine_params("fine", {{"speckle", 7}})->sgm().speckle, 7);
}

}  // namespace
}  // namespace duo
