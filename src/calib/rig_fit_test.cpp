// Whether pairs fit their rig: what is wrong is told with its cause, and what is right is not doubted.
#include "duoptic/rig_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "calib/scene_pose.h"
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
  const auto [w, h] = picture.size();
  return placed(picture, {w, h}, [w = w, h = h](int x, int y) { return std::pair(w - 1 - x, h - 1 - y); });
}
Image<Rgb8> mirror_of(const Image<Rgb8>& picture) {
  return placed(picture, picture.size(), [w = picture.width()](int x, int y) { return std::pair(w - 1 - x, y); });
}
Image<Rgb8> bottom_to_top(const Image<Rgb8>& picture) {
  return placed(picture, picture.size(), [h = picture.height()](int x, int y) { return std::pair(x, h - 1 - y); });
}
Image<Rgb8> negative_of(const Image<Rgb8>& picture) {
  Image<Rgb8> out = picture.clone();
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      Rgb8& p = out.at(y, x);
      p = {static_cast<std::uint8_t>(255 - p.r), static_cast<std::uint8_t>(255 - p.g), static_cast<std::uint8_t>(255 - p.b)};
    }
  return out;
}
/// A third as large.
Image<Rgb8> small_copy(const Image<Rgb8>& picture) {
  Image<Rgb8> out({picture.width() / 3, picture.height() / 3});
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      int r = 0, g = 0, b = 0;
      for (int i = 0; i < 9; ++i) {
        const Rgb8 p = picture.at(3 * y + i / 3, 3 * x + i % 3);
        r += p.r, g += p.g, b += p.b;
      }
      out.at(y, x) = {static_cast<std::uint8_t>(r / 9), static_cast<std::uint8_t>(g / 9), static_cast<std::uint8_t>(b / 9)};
    }
  return out;
}
Camera small_camera(Camera camera) {
  camera.size = {camera.size.width / 3, camera.size.height / 3};
  camera.fx_px /= 3, camera.fy_px /= 3;
  camera.cx_px = (camera.cx_px - 1) / 3, camera.cy_px = (camera.cy_px - 1) / 3;
  return camera;
}

/// A rectified pair.
const SyntheticPair& ideal_room() {
  static const SyntheticPair room = render_synthetic({.size = kRoomSize, .ideal = true}, 2);
  return room;
}

/// Six times as large. By hand: the middle of pixel x lies at 6 x + 2.5.
Image<Rgb8> large_copy(const Image<Rgb8>& picture) {
  return placed(picture, {6 * picture.width(), 6 * picture.height()}, [](int x, int y) { return std::pair(x / 6, y / 6); });
}
Camera large_camera(Camera camera) {
  camera.size = {6 * camera.size.width, 6 * camera.size.height};
  camera.fx_px *= 6, camera.fy_px *= 6;
  camera.cx_px = 6 * camera.cx_px + 2.5, camera.cy_px = 6 * camera.cy_px + 2.5;
  return camera;
}

/// By a seventh, around the middle.
Image<Rgb8> zoomed(const Image<Rgb8>& picture) {
  const auto [w, h] = picture.size();
  Image<Rgb8> out(picture.size());
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const double from_x = w / 16.0 + 0.875 * x, from_y = h / 16.0 + 0.875 * y;
      const int x0 = static_cast<int>(from_x), y0 = static_cast<int>(from_y);
      const double fx = from_x - x0, fy = from_y - y0;
      const auto mixed = [&](std::uint8_t Rgb8::*part) {
        const double upper = (1 - fx) * picture.at(y0, x0).*part + fx * picture.at(y0, x0 + 1).*part,
                     lower = (1 - fx) * picture.at(y0 + 1, x0).*part + fx * picture.at(y0 + 1, x0 + 1).*part;
        return static_cast<std::uint8_t>((1 - fy) * upper + fy * lower + 0.5);
      };
      out.at(y, x) = {mixed(&Rgb8::r), mixed(&Rgb8::g), mixed(&Rgb8::b)};
    }
  return out;
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

/// Rooms of different rigs, rendered once for all tests.
const SyntheticPair& fit_room(std::uint32_t seed) {
  static std::map<std::uint32_t, SyntheticPair> rooms;
  const auto [at, is_new] = rooms.try_emplace(seed);
  if (is_new) at->second = render_synthetic({.size = kRoomSize, .seed = seed}, 2);
  return at->second;
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

/// Beyond doubt, right or wrong, by one pair; what is in doubt is looked at in all.
TEST(RigFit, OnePairIsEnoughWhereNothingIsInDoubt) {
  PairList pairs = pairs_of(1);
  pairs.resize(3, pairs[0]);
  const RigFit fit = rig_fit(fit_room(1).rig, pairs, 2);
  expect_good(fit);
  ASSERT_TRUE(fit.scene);
  EXPECT_EQ(fit.scene->pairs, 1);
  const RigFit turned = rig_fit(right_turned(fit_room(1).rig, turn(0.3, 0, 0)), pairs, 2);
  ASSERT_TRUE(turned.scene);
  EXPECT_EQ(turned.scene->pairs, 1);
  const RigFit doubtful = rig_fit(right_turned(fit_room(1).rig, turn(0.06, 0, 0)), pairs, 2);
  ASSERT_TRUE(doubtful.scene);
  EXPECT_EQ(doubtful.scene->pairs, 3);
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

/// Points of a wall at one side of the picture: a pan of 0.6 degrees, and a baseline that turned, move rows there alike. That
/// only one camera turned, around its own centre, leaves the first alone.
TEST(RigFit, FewPointsKnowThePanOfOneCameraBetter) {
  Rig rig;
  rig.left = rig.right = {.size = {640, 480}, .fx_px = 500, .fy_px = 500, .cx_px = 319.5, .cy_px = 239.5};
  rig.right_from_left.t_m = {-0.12, 0, 0};
  const Rig turned = right_turned(rig, turn(0, 0.6, 0));
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.2);
  std::vector<SceneMatch> matches;
  for (int y = 20; y < 460; y += 40)
    for (int x = 400; x < 600; x += 40) {
      const Vec3 wall = 2.0 * Vec3{(x - 319.5) / 500, (y - 239.5) / 500, 1};
      const Vec3 p = turned.right_from_left.rotation * wall + turned.right_from_left.t_m;
      matches.push_back({{double(x), double(y)}, {500 * p.x / p.z + 319.5, 500 * p.y / p.z + 239.5 + noise(random)}});
    }
  const auto free = fit_scene_pose(rig, kFreePose, matches, 1), one = fit_scene_pose(rig, kRightTurned, matches, 1);
  ASSERT_TRUE(free && one);
  const double pan = 0.6 * M_PI / 180;
  EXPECT_NEAR(one->turned_rad.y, pan, 3 * one->turn_sigma_rad.y);
  EXPECT_LT(one->turn_sigma_rad.y, pan / 3);
  EXPECT_GT(free->turn_sigma_rad.y, 1.3 * one->turn_sigma_rad.y);
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

/// In pictures of few pixels, too; there, and where a rig does not know of it, by postures that are undone.
TEST(RigFit, APictureThatIsTurnedOverOrANegative) {
  constexpr std::uint32_t kSeed = 1;
  const Image<Rgb8>&left = fit_room(kSeed).pair.left.pixels, &right = fit_room(kSeed).pair.right.pixels;
  const Image<Rgb8> small_left = small_copy(left), small_right = small_copy(right);
  const std::optional<Rig> rig = fit_room(kSeed).rig;
  Rig small_rig = *rig;
  small_rig.left = small_camera(rig->left), small_rig.right = small_camera(rig->right);
  expect_good(rig_fit(small_rig, pairs_of(small_left, small_right), 2));
  expect_told(rig_fit(rig, pairs_of(left, right, negative_of, as_it_is), 2), "negative");
  expect_told(rig_fit({}, pairs_of(left, right, as_it_is, bottom_to_top), 2), "rows from bottom to top");
  for (const std::optional<Rig>& of : {std::optional(small_rig), std::optional<Rig>()}) {
    SCOPED_TRACE(of.has_value());
    expect_told(rig_fit(of, pairs_of(small_left, small_right, as_it_is, negative_of), 2), "negative");
    expect_told(rig_fit(of, pairs_of(small_left, small_right, as_it_is, upside_down), 2), "stands on its head");
    expect_told(rig_fit(of, pairs_of(small_left, small_right, mirror_of, as_it_is), 2), "one picture is mirrored");
  }
  expect_told(rig_fit(right_turned(small_rig, turn(1, 0, 0)), pairs_of(small_left, small_right), 2), "does not fit");
  // Too few points agree here to judge a rig by.
  const Image<Rgb8> dark_left = dark_copy(small_left), dark_right = dark_copy(small_right);
  expect_good(rig_fit({}, pairs_of(dark_left, dark_right), 2));
  expect_told(rig_fit({}, pairs_of(dark_left, dark_right, as_it_is, upside_down), 2), "stands on its head");
  expect_told(rig_fit({}, pairs_of(dark_left, dark_right, negative_of, as_it_is), 2), "negative");
}

/// Pictures of millions of pixels, which are looked at halved.
TEST(RigFit, LargePicturesAreJudgedAsTheirCopies) {
  const PairList pairs = pairs_of(1, large_copy, large_copy);
  Rig rig = fit_room(1).rig;
  rig.left = large_camera(rig.left), rig.right = large_camera(rig.right);
  const RigFit fit = rig_fit(rig, pairs, 2);
  expect_good(fit);
  ASSERT_TRUE(fit.scene);
  EXPECT_GT(fit.scene->points, 100);
  EXPECT_LT(fit.scene->row_px, 1);  // a sixth of a pixel of the small ones
  expect_told(rig_fit(right_turned(rig, turn(0.3, 0, 0)), pairs, 2), "a camera was turned by tilt -0.");
}

TEST(RigFit, BothPicturesOnTheirSide) {
  for (const std::uint32_t seed : {1u, 2u}) {
    SCOPED_TRACE(seed);
    expect_told(rig_fit({}, pairs_of(seed, on_its_side, on_its_side), 2), "both pictures lie on their side");
  }
}

/// Without a rig rows may be off, and are put right; those of a picture that was zoomed into are not.
TEST(RigFit, RowsOfAZoomedPictureDoNotFit) {
  const Image<Rgb8>&left = ideal_room().pair.left.pixels, &right = ideal_room().pair.right.pixels;
  const auto lower = [](const Image<Rgb8>& picture) {
    return placed(picture, kRoomSize, [](int x, int y) { return std::pair(x, y - 12); });
  };
  expect_good(rig_fit({}, pairs_of(left, right), 2));
  expect_good(rig_fit({}, pairs_of(left, right, as_it_is, lower), 2));
  expect_told(rig_fit({}, pairs_of(left, right, as_it_is, zoomed), 2), "the rows of both pictures do not fit");
  expect_told(rig_fit({}, pairs_of(left, right, zoomed, as_it_is), 2), "the rows of both pictures do not fit");
}

/// Without a rig columns have to be right. By hand: what is four thirds as wide in the one picture as in the other is a quarter
/// narrower in that one.
TEST(RigFit, AStretchedPictureIsTold) {
  const Image<Rgb8>&left = ideal_room().pair.left.pixels, &right = ideal_room().pair.right.pixels;
  const auto wider = [](const Image<Rgb8>& picture) {
    return placed(picture, kRoomSize, [](int x, int y) { return std::pair(240 + (x - 240) * 3 / 4, y); });
  };
  expect_told(rig_fit({}, pairs_of(left, right, wider, as_it_is), 2), "% narrower than the left one");
  expect_told(rig_fit({}, pairs_of(left, right, as_it_is, wider), 2), "% wider than the left one");
  // Moved against each other, as stereo films are, some lie beyond infinity.
  const auto moved = [](const Image<Rgb8>& picture) {
    return placed(picture, kRoomSize, [](int x, int y) { return std::pair(x - 20, y); });
  };
  expect_told(rig_fit({}, pairs_of(left, right, as_it_is, moved), 2), "give a rig, or move the pictures apart");
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
  // A camera matrix of 960x720 with the size that the pictures have, and one of 320x240.
  for (const double factor : {2.0, 2 / 3.0}) {
    Rig other = fit_room(1).rig;
    for (Camera* camera : {&other.left, &other.right})
      for (double* value : {&camera->fx_px, &camera->fy_px, &camera->cx_px, &camera->cy_px}) *value *= factor;
    expect_told(rig_fit(other, pairs_of(1), 2), factor > 1 ? "middle of about 1024x768" : "middle of about 320x240");
  }
}

}  // namespace
}  // namespace duo
