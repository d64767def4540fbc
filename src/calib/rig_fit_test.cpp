// Whether pairs fit their rig: what is wrong is told with its cause, and what is right is not doubted.
#include "duoptic/rig_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "duoptic/synthetic.h"
#include "tests/turned_rig.h"

namespace duo {
namespace {

using test::right_turned;
using test::turn;
using PairList = std::vector<std::shared_ptr<const Pair>>;
using PictureChange = Image<Rgb8> (*)(const Image<Rgb8>&);

constexpr Size kRoomSize = {480, 360};

Image<Rgb8> as_it_is(const Image<Rgb8>& picture) { return picture.clone(); }

template <class Place>
Image<Rgb8> placed(const Image<Rgb8>& picture, Size size, Place place) {
  Image<Rgb8> out(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const auto [from_x, from_y] = place(x, y);
      if (from_x >= 0 && from_y >= 0 && from_x < picture.width() && from_y < picture.height())
        out.at(y, x) = picture.at(from_y, from_x);
    }
  return out;
}
Image<Rgb8> upside_down(const Image<Rgb8>& picture) {
  return placed(picture, kRoomSize, [](int x, int y) { return std::pair(kRoomSize.width - 1 - x, kRoomSize.height - 1 - y); });
}
Image<Rgb8> mirror_of(const Image<Rgb8>& picture) {
  return placed(picture, kRoomSize, [](int x, int y) { return std::pair(kRoomSize.width - 1 - x, y); });
}
/// As a camera that lies on its side sees the middle of the room.
Image<Rgb8> on_its_side(const Image<Rgb8>& picture) {
  return placed(picture, kRoomSize, [](int x, int y) {
    return std::pair(kRoomSize.width / 2 + (y - kRoomSize.height / 2), kRoomSize.height / 2 - (x - kRoomSize.width / 2));
  });
}
/// In a dark room: a quarter of the light, and noise.
Image<Rgb8> dark_copy(const Image<Rgb8>& picture) {
  static std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 3);
  Image<Rgb8> out(picture.size());
  const auto level = [&](int value) { return static_cast<std::uint8_t>(std::clamp(value / 4.0 + noise(random), 0.0, 255.0)); };
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const Rgb8 p = picture.at(y, x);
      out.at(y, x) = {level(p.r), level(p.g), level(p.b)};
    }
  return out;
}

/// Two rooms of different rigs, rendered once for all tests.
const SyntheticPair& fit_room(std::uint32_t seed) {
  static const SyntheticPair rooms[] = {render_synthetic({.size = kRoomSize, .seed = 1}, 2),
                                        render_synthetic({.size = kRoomSize, .seed = 2}, 2)};
  return rooms[seed - 1];
}

PairList pairs_of(const Image<Rgb8>& left, const Image<Rgb8>& right, PictureChange of_left = as_it_is,
                  PictureChange of_right = as_it_is) {
  auto pair = std::make_shared<Pair>();
  pair->left.pixels = of_left(left);
  pair->right.pixels = of_right(right);
  return {pair};
}
PairList pairs_of(std::uint32_t seed, PictureChange of_left = as_it_is, PictureChange of_right = as_it_is) {
  return pairs_of(fit_room(seed).pair.left.pixels, fit_room(seed).pair.right.pixels, of_left, of_right);
}

/// Of another place: rectangles everywhere.
Image<Rgb8> elsewhere() {
  std::mt19937 random(3);
  const auto up_to = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  Image<Rgb8> out(kRoomSize);
  for (int i = 0; i < 400; ++i) {
    const int x0 = up_to(kRoomSize.width), y0 = up_to(kRoomSize.height), w = 8 + up_to(40), h = 8 + up_to(40);
    const auto level = static_cast<std::uint8_t>(up_to(256));
    for (int y = y0; y < std::min(y0 + h, kRoomSize.height); ++y)
      for (int x = x0; x < std::min(x0 + w, kRoomSize.width); ++x) out.at(y, x) = {level, level, level};
  }
  return out;
}

void expect_told(const RigFit& fit, const std::string& words) {
  EXPECT_NE(fit.verdict, RigVerdict::kGood) << words;
  EXPECT_NE(fit.what.find(words), std::string::npos) << words << ": " << fit.what;
  EXPECT_EQ(fit.what.find('\n'), std::string::npos);
}
void expect_good(const RigFit& fit) {
  EXPECT_EQ(fit.verdict, RigVerdict::kGood) << fit.what;
  EXPECT_TRUE(fit.what.empty());
  EXPECT_EQ(fit.disparity_sigma_px, 0);
}

TEST(RigFit, TheRightRigIsNotDoubted) {
  for (const std::uint32_t seed : {1u, 2u}) {
    SCOPED_TRACE(seed);
    const RigFit fit = rig_fit(fit_room(seed).rig, pairs_of(seed), 2);
    expect_good(fit);
    ASSERT_TRUE(fit.scene);
    EXPECT_GT(fit.scene->points, 150);
    expect_good(rig_fit(fit_room(seed).rig, pairs_of(seed, dark_copy, dark_copy), 2));
  }
}

/// Beyond doubt by one pair; what is wrong is looked at in all.
TEST(RigFit, OnePairIsEnoughWhereAllIsRight) {
  PairList pairs = pairs_of(1);
  pairs.resize(3, pairs[0]);
  const RigFit fit = rig_fit(fit_room(1).rig, pairs, 2);
  expect_good(fit);
  ASSERT_TRUE(fit.scene);
  EXPECT_EQ(fit.scene->pairs, 1);
  const RigFit turned = rig_fit(right_turned(fit_room(1).rig, turn(0, 0.6, 0)), pairs, 2);
  ASSERT_TRUE(turned.scene);
  EXPECT_EQ(turned.scene->pairs, 3);
}

TEST(RigFit, ATurnedCameraAndAnotherRigAreTold) {
  for (const std::uint32_t seed : {1u, 2u})
    for (const Mat3& by : {turn(0, 0.6, 0), turn(0, -0.6, 0), turn(0.3, 0, 0), turn(-0.3, 0, 0)}) {
      SCOPED_TRACE(seed);
      const RigFit fit = rig_fit(right_turned(fit_room(seed).rig, by), pairs_of(seed), 2);
      expect_told(fit, "the rig does not fit these pictures");
      EXPECT_GT(fit.disparity_sigma_px, 0.5);
      EXPECT_LT(fit.disparity_sigma_px, 20);
    }
  expect_told(rig_fit(fit_room(2).rig, pairs_of(1), 2), "another rig's file");
  expect_told(rig_fit(fit_room(1).rig, pairs_of(2), 2), "another rig's file");
}

TEST(RigFit, KnownCausesAreNamed) {
  const std::optional<Rig> rig = fit_room(1).rig;
  const Image<Rgb8>&left = fit_room(1).pair.left.pixels, &right = fit_room(1).pair.right.pixels;
  expect_told(rig_fit(rig, pairs_of(right, left), 2), "left and right are swapped: ");
  expect_told(rig_fit(rig, pairs_of(1, mirror_of, mirror_of), 2), "both pictures are mirrored: ");
  // The rows of a rectified pair do not tell the two apart; without a rig there are no others.
  expect_told(rig_fit({}, pairs_of(right, left), 2), "left and right are swapped, or both pictures are mirrored");
  expect_told(rig_fit({}, pairs_of(1, mirror_of, mirror_of), 2), "left and right are swapped, or both pictures are mirrored");
  expect_told(rig_fit(rig, pairs_of(1, upside_down, as_it_is), 2), "stands on its head");
  expect_told(rig_fit(rig, pairs_of(1, as_it_is, mirror_of), 2), "one picture is mirrored");
  expect_told(rig_fit(rig, pairs_of(1, on_its_side, as_it_is), 2), "lies on its side");
  expect_told(rig_fit(rig, pairs_of(1, as_it_is, on_its_side), 2), "lies on its side");
  for (const std::optional<Rig>& of : {rig, std::optional<Rig>()}) {
    SCOPED_TRACE(of.has_value());
    expect_told(rig_fit(of, pairs_of(left, left), 2), "the same picture");
    expect_told(rig_fit(of, pairs_of(1, as_it_is, upside_down), 2), "stands on its head");
    expect_told(rig_fit(of, pairs_of(left, elsewhere()), 2), "nothing in common");
  }
}

TEST(RigFit, WhatCannotBeSeenIsNotDoubted) {
  const Image<Rgb8> blank(kRoomSize);
  expect_good(rig_fit(fit_room(1).rig, pairs_of(blank, blank), 2));
  expect_good(rig_fit({}, pairs_of(blank, fit_room(1).pair.right.pixels), 2));
  expect_good(rig_fit({}, {}, 1));
  const SyntheticPair ideal = render_synthetic({.size = {320, 240}, .ideal = true}, 2);
  expect_good(rig_fit({}, pairs_of(ideal.pair.left.pixels, ideal.pair.right.pixels), 2));
}

TEST(RigFit, NumbersThatAreOfNoUseAndGuesses) {
  Rig rig = fit_room(1).rig;
  rig.metric = false;
  expect_told(rig_fit(rig, pairs_of(1), 2), "not metric");
  rig.left.distortion = {-0.6, 0, 0, 0, 0, 0, 0, 0};
  expect_told(rig_fit(rig, pairs_of(1), 2), "turns back inside the picture");
}

}  // namespace
}  // namespace duo
