// A rig judged in steps: by few points, as a recording does, and of two photos between which things moved.
#include "calib/rig_fitting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "duoptic/synthetic.h"
#include "tests/turned_rig.h"

namespace duo {
namespace {

using test::right_turned;
using test::turn;
using PairPointer = std::shared_ptr<const Pair>;

const SyntheticPair& judged_room() {
  static const SyntheticPair room = render_synthetic({.seed = 3}, 2);
  return room;
}

PairPointer pair_of(const Image<Rgb8>& left, const Image<Rgb8>& right) {
  auto pair = std::make_shared<Pair>();
  pair->left.pixels = left.clone();
  pair->right.pixels = right.clone();
  return pair;
}

/// In a quarter of the light, with noise of this standard deviation.
Image<Rgb8> dimmed(const Image<Rgb8>& picture, double noise, std::mt19937& random) {
  std::normal_distribution<double> normal(0, noise);
  Image<Rgb8> out(picture.size());
  const auto level = [&](int value) { return static_cast<std::uint8_t>(std::clamp(value / 4.0 + normal(random), 0.0, 255.0)); };
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const Rgb8 p = picture.at(y, x);
      out.at(y, x) = {level(p.r), level(p.g), level(p.b)};
    }
  return out;
}

/// It, rectified.
const SyntheticPair& ideal_of_judged_room() {
  static const SyntheticPair room = render_synthetic({.seed = 3, .ideal = true}, 2);
  return room;
}

/// As RigWatch asks: the first pair, and where it leaves a doubt all three.
RigFit by_few_points(const std::optional<Rig>& rig, const std::vector<PairPointer>& pairs) {
  RigFitting fitting(rig, pairs[0]->left.pixels.size(), 1, SceneSearch::kQuick);
  const auto fit = fitting.by_first(pairs[0]);
  return fit ? *fit : fitting.by_all(std::span(pairs).subspan(1), nullptr);
}

TEST(RigFitting, FewPointsTellWhatAllTell) {
  const SyntheticPair& room = judged_room();
  const Image<Rgb8>&left = room.pair.left.pixels, &right = room.pair.right.pixels;
  std::mt19937 random(5);
  std::vector<PairPointer> light(3, pair_of(left, right)), dark;
  for (int i = 0; i < 3; ++i) dark.push_back(pair_of(dimmed(left, 2, random), dimmed(right, 2, random)));
  for (const auto& pairs : {light, dark}) {
    const RigFit good = by_few_points(room.rig, pairs);
    EXPECT_EQ(good.verdict, RigVerdict::kGood) << good.what;
    EXPECT_EQ(good.what, "");
    ASSERT_TRUE(good.scene);
    EXPECT_LE(good.scene->points, static_cast<int>(8 * 48 * pairs.size()));
    for (const Mat3& by : {turn(0, 0.6, 0), turn(0, -0.6, 0), turn(0.3, 0, 0), turn(-0.3, 0, 0)}) {
      const RigFit fit = by_few_points(right_turned(room.rig, by), pairs);
      EXPECT_NE(fit.verdict, RigVerdict::kGood);
      EXPECT_NE(fit.what.find("does not fit"), std::string::npos) << fit.what;
    }
    EXPECT_NE(by_few_points(synthetic_rig({.seed = 4}), pairs).what.find("another rig's file"), std::string::npos);
  }
  const RigFit swapped = by_few_points(room.rig, {pair_of(right, left)});
  EXPECT_NE(swapped.what.find("left and right are swapped"), std::string::npos) << swapped.what;
}

/// What by_all() cannot use nobody need sum.
TEST(RigFitting, SumsAreForMetricRigsThatAreSearchedThoroughly) {
  const Rig rig = synthetic_rig({.seed = 3});
  const auto looks = [](const std::optional<Rig>& at, SceneSearch most) {
    return RigFitting(at, {640, 480}, 1, most).looks_at_sum();
  };
  EXPECT_TRUE(looks(rig, SceneSearch::kThorough));
  EXPECT_FALSE(looks(rig, SceneSearch::kQuick));
  EXPECT_FALSE(looks(std::nullopt, SceneSearch::kThorough));
  Rig guessed = rig;
  guessed.metric = false;
  EXPECT_FALSE(looks(guessed, SceneSearch::kThorough));
}

/// Of the same pair again the same matches come again, at the same places: of one whose right picture lies a row lower, a row
/// lower.
TEST(RigFitting, MatchesAreFoundAgainInTheNextPair) {
  const SyntheticPair& room = judged_room();
  const Image<Rgb8>& right = room.pair.right.pixels;
  Image<Rgb8> lower = right.clone();
  for (int y = 1; y < right.height(); ++y) std::copy_n(right.row(y - 1), right.width(), lower.row(y));
  for (const int rows : {0, 1}) {
    SceneMatcher matcher(right.size(), 1, SceneSearch::kQuick);
    matcher.add(*pair_of(room.pair.left.pixels, right));
    const std::vector<SceneMatch> once = matcher.matches().matches;
    matcher.add_same(*pair_of(room.pair.left.pixels, rows == 0 ? right : lower));
    const SceneMatches twice = matcher.matches();
    EXPECT_EQ(twice.pairs, 2);
    EXPECT_GT(twice.matches.size(), 1.9 * static_cast<double>(once.size()));
    EXPECT_LE(twice.matches.size(), 2 * once.size());
    std::size_t again = 0;
    for (const SceneMatch& a : once)
      for (const SceneMatch& b : twice.matches)
        again += a.left_px.x == b.left_px.x && a.left_px.y == b.left_px.y &&
                 std::abs(b.right_px.y - a.right_px.y - rows) < 0.05 && std::abs(b.right_px.x - a.right_px.x) < 0.2;
    EXPECT_GT(again, (rows == 0 ? 1.9 : 0.9) * static_cast<double>(once.size()));
  }
}

/// Of pictures that do not agree few points may say why, too; of a room in which few agree, because it is dark, they say
/// nothing.
TEST(RigFitting, FewPointsTellWhyPicturesDoNotAgree) {
  const SyntheticPair& room = judged_room();
  const Image<Rgb8>&left = room.pair.left.pixels, &right = room.pair.right.pixels;
  const auto [w, h] = right.size();
  Image<Rgb8> turned(right.size());
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) turned.at(y, x) = right.at(h - 1 - y, w - 1 - x);
  Image<Rgb8> elsewhere(right.size());  // squares everywhere
  std::mt19937 random(3);
  for (int i = 0; i < 1000; ++i) {
    const int x0 = static_cast<int>(random() % 620), y0 = static_cast<int>(random() % 460),
              side = 6 + static_cast<int>(random() % 14);
    const auto level = static_cast<std::uint8_t>(random() % 256);
    for (int y = y0; y < y0 + side; ++y) std::fill_n(elsewhere.row(y) + x0, side, Rgb8{level, level, level});
  }
  const auto told = [&](const Image<Rgb8>& other) {
    return by_few_points(room.rig, std::vector<PairPointer>(3, pair_of(left, other))).what;
  };
  EXPECT_NE(told(turned).find("stands on its head"), std::string::npos);
  EXPECT_NE(told(elsewhere).find("nothing in common"), std::string::npos);
  std::vector<PairPointer> dark;
  for (int i = 0; i < 3; ++i) dark.push_back(pair_of(dimmed(left, 14, random), dimmed(right, 14, random)));
  EXPECT_EQ(by_few_points(room.rig, dark).what, "");
}

/// What looks alike by chance in a mirrored picture is the same in pair after pair, and as many as a few real points.
TEST(RigFitting, WhatLooksAlikeByChanceIsNoRoom) {
  const SyntheticPair room = render_synthetic({.size = {480, 360}, .seed = 4}, 2);
  const auto [w, h] = room.pair.left.pixels.size();
  Image<Rgb8> mirrored(room.pair.left.pixels.size());
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) mirrored.at(y, x) = room.pair.left.pixels.at(y, w - 1 - x);
  const std::vector<PairPointer> pairs(3, pair_of(mirrored, room.pair.right.pixels));
  RigFitting fitting(room.rig, {w, h}, 1);
  ASSERT_FALSE(fitting.by_first(pairs[0]));
  EXPECT_NE(fitting.by_all(std::span(pairs).subspan(1), nullptr).what.find("one picture is mirrored"), std::string::npos);
}

/// What is said of pan and rows is of one pose: where one camera turned around its centre, its rows fit once it is turned back.
TEST(RigFitting, PanAndWhatRowsKeepAreOfOnePose) {
  const SyntheticPair& room = judged_room();
  const std::vector<PairPointer> pairs(3, pair_of(room.pair.left.pixels, room.pair.right.pixels));
  const RigFit fit = by_few_points(right_turned(room.rig, turn(0, 0.6, 0)), pairs);
  ASSERT_TRUE(fit.scene);
  EXPECT_NEAR(fit.scene->pan_px, std::abs(fit.scene->turned_rad.y) * room.rig.left.fx_px, 1e-9);
  EXPECT_NEAR(fit.scene->pan_px, 0.6 * test::kDeg * room.rig.left.fx_px, 3 * fit.scene->pan_sigma_px);
  EXPECT_LT(fit.scene->lens_row_px, 0.25);
}

/// With a mottled square of 120 x 120 pixels.
Image<Rgb8> with_thing(const Image<Rgb8>& picture, int at_x, int at_y) {
  Image<Rgb8> out = picture.clone();
  std::mt19937 random(9);
  for (int block_y = 0; block_y < 12; ++block_y)
    for (int block_x = 0; block_x < 12; ++block_x) {
      const auto level = static_cast<std::uint8_t>(random() % 256);
      for (int i = 0; i < 100; ++i) out.at(at_y + 10 * block_y + i / 10, at_x + 10 * block_x + i % 10) = {level, level, level};
    }
  return out;
}

/// Of two like things in the right photo the lower one looks exactly as the left photo's does, the other, on its row, nearly.
TEST(RigFitting, WhatStandsThereTwiceHasNotMoved) {
  const SyntheticPair& ideal = ideal_of_judged_room();
  Image<Rgb8> twice = with_thing(with_thing(ideal.pair.right.pixels, 280, 330), 280, 180);
  std::mt19937 random(4);
  for (int y = 180; y < 300; ++y)
    for (int x = 280; x < 400; ++x) {
      const int level = std::clamp(twice.at(y, x).r + static_cast<int>(random() % 81) - 40, 0, 255);
      twice.at(y, x) = {static_cast<std::uint8_t>(level), static_cast<std::uint8_t>(level), static_cast<std::uint8_t>(level)};
    }
  const PairPointer pair = pair_of(with_thing(ideal.pair.left.pixels, 300, 180), twice);
  RigFitting fitting(ideal.rig, twice.size(), 1, SceneSearch::kThorough, true);
  const auto fit = fitting.by_first(pair);
  EXPECT_EQ(fit ? fit->what : fitting.by_all({}, nullptr).what, "");
}

/// A picture on the wall hangs `down` pixels lower in the right photo.
TEST(RigFitting, WhatMovedBetweenTwoPhotosIsTold) {
  const SyntheticPair& ideal = ideal_of_judged_room();
  const auto fit_of = [&](int down, bool still, bool with_rig) {
    const PairPointer pair =
        pair_of(with_thing(ideal.pair.left.pixels, 300, 180), with_thing(ideal.pair.right.pixels, 280, 180 + down));
    RigFitting fitting(with_rig ? std::optional(ideal.rig) : std::nullopt, pair->left.pixels.size(), 1, SceneSearch::kThorough,
                       still);
    const auto fit = fitting.by_first(pair);
    return fit ? *fit : fitting.by_all({}, nullptr);
  };
  for (const bool with_rig : {true, false}) {
    SCOPED_TRACE(with_rig);
    const RigFit moved = fit_of(30, true, with_rig);
    EXPECT_NE(moved.what.find("something moved between the two pictures"), std::string::npos) << moved.what;
    EXPECT_NE(moved.what.find("30 px off their rows"), std::string::npos) << moved.what;
    EXPECT_EQ(moved.verdict, RigVerdict::kCanBeImproved);
    EXPECT_EQ(fit_of(0, true, with_rig).what, "");
    EXPECT_EQ(fit_of(30, false, with_rig).what, "");  // of a video that may be one of many frames
  }
}

}  // namespace
}  // namespace duo
