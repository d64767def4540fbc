// Who stands there, by depth alone, and what the network of bodies says of it.
#include <gtest/gtest.h>

#include "trackers/body/newcomers.h"
#include "trackers/body/standing.h"

namespace duo::body {
namespace {

using test::Map;

// 2 m away 200 px are a metre. Cells of the map are 7 px.
constexpr Window kPerson = {140, 21, 98, 210};

Map room_with(const Window& what, double z_m) {
  Map map;
  map.fill({0, 0, 320, 240}, 4);
  map.fill(what, z_m);
  return map;
}

TEST(Upright, APersonSizedThingIsFoundWhereItStands) {
  const Map map = room_with(kPerson, 2);
  Uprights uprights;
  const auto found = uprights.find(map.view());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].z_m, 2, 0.01);
  EXPECT_EQ(found[0].box_px, kPerson);
  EXPECT_FALSE(found[0].cut_above);
  // The hips are 82 cm below the hair, and the region reaches 1.1 m to each side.
  const TurnedSquare region = region_of(map.view(), found[0], 0);
  EXPECT_EQ(region.x_q8, 256 * (140 + 49));
  EXPECT_NEAR(region.y_q8 / 256.0, 21 + 0.82 * 200, 1);
  EXPECT_NEAR(region.right_x_q8 / 256.0, 1.1 * 200, 1);
}

TEST(Upright, WhomTheUpperBorderCutsStandsHigher) {
  const Map map = room_with({140, 0, 98, 210}, 2);
  Uprights uprights;
  const auto found = uprights.find(map.view());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].cut_above);
  EXPECT_NEAR(region_of(map.view(), found[0], 0.32).y_q8 / 256.0, 0.5 * 200, 1);
}

TEST(Upright, WallsSofasDogsAndFloorsAreNone) {
  Uprights uprights;
  EXPECT_TRUE(uprights.find(room_with({}, 0).view()).empty());                  // a wall alone
  EXPECT_TRUE(uprights.find(room_with({20, 60, 280, 170}, 2).view()).empty());  // 1.4 m wide
  EXPECT_TRUE(uprights.find(room_with({140, 140, 70, 70}, 2).view()).empty());  // 35 cm high
  EXPECT_TRUE(uprights.find(room_with({140, 20, 21, 200}, 2).view()).empty());  // a pole
  Map floor;
  for (int y = 130; y < 240; ++y) floor.fill({100, y, 100, 1}, 400 * 1.2 / (y - 120.0));
  EXPECT_TRUE(uprights.find(floor.view()).empty());
}

TEST(Upright, TheNearerOfTwoComesFirst) {
  Map map = room_with(kPerson, 2.5);
  map.fill({21, 28, 98, 212}, 1.5);  // whom the lower border cuts
  Uprights uprights;
  const auto found = uprights.find(map.view());
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0].z_m, 1.5, 0.01);
  EXPECT_NEAR(found[1].z_m, 2.5, 0.02);
}

/// More than the list holds, side by side, the nearest on the right: the farthest are left out. A cell is 22 cm wide there.
TEST(Upright, OfManyTheNearestAreFound) {
  Map map = room_with({}, 0);
  static_cast<Pinhole&>(map.geometry_) = {100, 160, 120, 0.4};
  for (int i = 0; i < 22; ++i) map.fill({14 * i, 21, 7, 210}, i == 21 ? 2.9 : 3.3);
  Uprights uprights;
  const auto found = uprights.find(map.view());
  ASSERT_EQ(found.size(), 16u);
  EXPECT_NEAR(found[0].z_m, 2.9, 0.05);
  EXPECT_NEAR(found[1].z_m, 3.3, 0.05);
}

/// Says of every region below a line how sure it is that there is somebody, with a trunk in its middle, and counts.
class OneAnswer final : public Detector {
 public:
  std::span<const FoundPerson> find(View<const Rgb8>, Window) override { return {}; }
  void bodies(std::span<const Look> looks, std::span<SeenBody> out) override {
    for (std::size_t i = 0; i < looks.size(); ++i) {
      ++asked;
      const TurnedSquare& region = looks[i].region;
      out[i] = {};
      out[i].score_q15 = region.y_q8 / 256 > below_px ? score_q15 : 0;
      out[i].next = region;
      using enum BodyPoint;
      for (const auto& [point, x, y] : {std::tuple{kLeftShoulder, 20, -80}, std::tuple{kRightShoulder, -20, -80},
                                        std::tuple{kLeftHip, 15, 0}, std::tuple{kRightHip, -15, 0}}) {
        out[i].points[static_cast<std::size_t>(point)].x_q8 = region.x_q8 + 256 * x;
        out[i].points[static_cast<std::size_t>(point)].y_q8 = region.y_q8 + 256 * y;
      }
    }
  }
  void hands(std::span<const Look>, std::span<SeenHand>) override {}
  bool sees_hands() const override { return false; }

  std::uint16_t score_q15 = 32000;
  int below_px = 0;
  int asked = 0;
};

TEST(Newcomers, WhoIsTrackedIsNotNew) {
  const Map map = room_with(kPerson, 2);
  const Image<Rgb8> picture({320, 240});
  const FrameView frame{map.view(), picture, 1.0 / 30, BodyModel::kLite, {}};
  OneAnswer detector;
  Newcomers newcomers;
  const std::array<Vec3, 1> here = {Vec3{0.1, 0.2, 2.1}}, elsewhere = {Vec3{1.2, 0.2, 2.1}};
  EXPECT_FALSE(newcomers.look(detector, frame, here));
  EXPECT_EQ(detector.asked, 0);
  const auto found = newcomers.look(detector, frame, elsewhere);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->x_q8 / 256.0, 189, 1);
}

TEST(Newcomers, OfWhomTheBorderCutsMoreThanOneHeightIsTried) {
  const Map map = room_with({140, 0, 98, 210}, 2);
  const Image<Rgb8> picture({320, 240});
  const FrameView frame{map.view(), picture, 1.0 / 30, BodyModel::kLite, {}};
  OneAnswer detector;
  detector.below_px = 120;  // 60 cm; where the head and shoulders are out the hips would be at 50 cm
  Newcomers newcomers;
  const auto found = newcomers.look(detector, frame, {});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->y_q8 / 256.0, 0.72 * 200, 1);
  EXPECT_EQ(detector.asked, 1 + 3);
}

TEST(Newcomers, WhatIsNoPersonIsLeftAloneForFiveCalls) {
  const Map map = room_with(kPerson, 2);
  const Image<Rgb8> picture({320, 240});
  const FrameView frame{map.view(), picture, 1.0 / 30, BodyModel::kLite, {}};
  OneAnswer detector;
  detector.score_q15 = 3000;
  Newcomers newcomers;
  for (int call = 0; call < 6; ++call) EXPECT_FALSE(newcomers.look(detector, frame, {}));
  EXPECT_EQ(detector.asked, 1);
  newcomers.look(detector, frame, {});
  EXPECT_EQ(detector.asked, 2);
  detector.score_q15 = 18000;  // there may be somebody: looked at three times, and not surely
  Newcomers others;
  EXPECT_FALSE(others.look(detector, frame, {}));
  EXPECT_EQ(detector.asked, 5);
}

/// Somebody may stand where a thing is that is none; where somebody was a mistake, only a trunk elsewhere is another's.
TEST(Newcomers, AThingThatIsNoPersonKeepsNobodyFromStarting) {
  const Map map = room_with(kPerson, 2);
  const Image<Rgb8> picture({320, 240});
  const FrameView frame{map.view(), picture, 1.0 / 30, BodyModel::kLite, {}};
  OneAnswer detector;
  detector.score_q15 = 3000;
  Newcomers newcomers;
  const Vec3 at = map.geometry_.unproject({kPerson.x + kPerson.width / 2.0, kPerson.y + kPerson.height / 2.0}, 2);
  EXPECT_FALSE(newcomers.look(detector, frame, {}));
  EXPECT_FALSE(newcomers.was_mistaken(at));
  newcomers.add_mistake(at);
  EXPECT_TRUE(newcomers.was_mistaken(at + Vec3{0.1, 0.1, 0.1}));
  EXPECT_FALSE(newcomers.was_mistaken(at + Vec3{0, 0.3, 0}));
  for (int call = 0; call < 6; ++call) newcomers.look(detector, frame, {});
  EXPECT_FALSE(newcomers.was_mistaken(at));
}

TEST(Newcomers, WhereSomebodyWasAMistakeNobodyIsLookedFor) {
  const Map map = room_with(kPerson, 2);
  const Image<Rgb8> picture({320, 240});
  const FrameView frame{map.view(), picture, 1.0 / 30, BodyModel::kLite, {}};
  OneAnswer detector;
  Newcomers newcomers;
  newcomers.add_mistake(map.geometry_.unproject({kPerson.x + kPerson.width / 2.0, 0}, 2));
  EXPECT_FALSE(newcomers.look(detector, frame, {}));
  EXPECT_EQ(detector.asked, 0);
}

}  // namespace
}  // namespace duo::body
