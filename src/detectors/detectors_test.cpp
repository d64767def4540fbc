#include <cstdlib>

#include "detectors/find_people.h"
#include "detectors/fixed.h"
#include "detectors/place.h"
#include "detectors/see_points.h"
#include "detectors/truth_detector.h"
#include "tests/agree.h"
#include "tests/allocations.h"
#include "tests/data.h"

namespace duo {
namespace {

// By hand: 1 / (1 + e^-1) = 0.7310586 -> 23955.3; e^-16 is below 1 / 65536.
TEST(Fixed, Sigmoid) {
  EXPECT_EQ(sigmoid_q15(0), 16384);
  EXPECT_EQ(sigmoid_q15(128), 23955);
  EXPECT_EQ(sigmoid_q15(-128), 32768 - 23955);
  EXPECT_EQ(sigmoid_q15(16 * 128), 32768);
  EXPECT_EQ(sigmoid_q15(1 << 30), 32768);
  EXPECT_EQ(sigmoid_q15(-(1 << 30)), 0);
  for (int x = -2100; x < 2100; ++x) EXPECT_LE(sigmoid_q15(x), sigmoid_q15(x + 1));
}

TEST(Fixed, Rounding) {
  EXPECT_EQ(rescaled(5, 6, 8), 20);
  EXPECT_EQ(rescaled(6, 10, 8), 2) << "1.5 goes up";
  EXPECT_EQ(rescaled(-6, 10, 8), -1);
  EXPECT_EQ(rescaled(-7, 10, 8), -2);
  EXPECT_EQ(rounded_quotient(7, 2), 4);
  EXPECT_EQ(rounded_quotient(-7, 2), -3);
  EXPECT_EQ(rounded_quotient(-8, 3), -3);
  for (const std::int64_t n : {0, 1, 3, 4, 99, 100}) EXPECT_EQ(integer_root(n), static_cast<std::int64_t>(std::sqrt(n)));
  EXPECT_EQ(integer_root(std::int64_t{3037000499} * 3037000499), 3037000499);
}

// By hand: a circle of 100 px above (500, 300): a square of 250 px, upright; turned a quarter, its right side is below.
TEST(Place, SquareAroundACircle) {
  const TurnedSquare upright = region_around({500 * 256, 300 * 256}, {500 * 256, 200 * 256});
  EXPECT_EQ(upright, (TurnedSquare{500 * 256, 300 * 256, 125 * 256, 0}));
  EXPECT_EQ(half_side(upright), 125 * 256);
  EXPECT_EQ(region_around({0, 0}, {100 * 256, 0}), (TurnedSquare{0, 0, 0, 125 * 256}));
  // The crop's upper left corner and its middle.
  EXPECT_EQ(placed(upright, {0, 0}, 256).x, 375 * 256);
  EXPECT_EQ(placed(upright, {0, 0}, 256).y, 175 * 256);
  const PointQ8 turned = placed({0, 0, 0, 125 * 256}, {256 * 256, 128 * 256}, 256);  // the middle of the right side
  EXPECT_EQ(turned.x, 0);
  EXPECT_EQ(turned.y, 125 * 256);
  EXPECT_EQ(placed_length(upright, 256, 256), 250) << "a pixel of the crop";
  EXPECT_TRUE(usable(upright, {640, 480}));
  EXPECT_FALSE(usable({0, 0, 3 * 256, 0}, {640, 480})) << "too small";
  EXPECT_FALSE(usable({0, 0, 2000 * 256, 0}, {640, 480})) << "too large";
  EXPECT_FALSE(usable({-700 * 256, 0, 100 * 256, 0}, {640, 480})) << "far away";
  // 20000 px away and 16000 to its right side: 36000 px are more than 2^31 in 1/65536 px.
  constexpr Size kHuge{15000, 15000};
  EXPECT_TRUE(usable({20000 * 256, 0, 12000 * 256, 0}, kHuge));
  EXPECT_FALSE(usable({20000 * 256, 0, 16000 * 256, 0}, kHuge)) << "beyond what crops reach";
  EXPECT_FALSE(usable({0, 20000 * 256, 0, 16000 * 256}, kHuge)) << "beyond what crops reach";
}

/// Grids in which nobody is.
struct Grids {
  std::vector<std::int16_t> scores[3], boxes[3];
  std::array<DetectorGrid, 3> grids;
  Grids() {
    constexpr int kSide[] = {28, 14, 7}, kAnchors[] = {2, 2, 6};
    for (int i = 0; i < 3; ++i) {
      const int places = kSide[i] * kSide[i];
      scores[i].assign(places * kAnchors[i], -1000);
      boxes[i].assign(places * kAnchors[i] * 12, 0);
      grids[i] = {{scores[i].data(), {kSide[i], kSide[i]}, kAnchors[i]},
                  {boxes[i].data(), {kSide[i], kSide[i]}, 12 * kAnchors[i]},
                  7,
                  4};
    }
  }
  /// A box of 32 px around the middle of the anchors' place on the coarsest grid, its hips there and its circle `up` px high.
  void add(int place, int anchor, int score, int up) {
    scores[2][place * 6 + anchor] = static_cast<std::int16_t>(score);
    std::int16_t* box = boxes[2].data() + (place * 6 + anchor) * 12;
    box[2] = box[3] = 32 * 16;
    box[7] = static_cast<std::int16_t>(-up * 16);
  }
};

// By hand, in a picture of 224 px: anchors of place (3, 3) are at 112 px. Two boxes there with scores 0.5 and 0.73 become one
// whose circle is (20 * 16384 + 40 * 23955) / 40339 = 31.88 px high, x 1.25 = 39.85; the one at place (0, 0), 16 px, stays
// apart.
TEST(FindPeople, OverlappingBoxesBecomeTheirMean) {
  Grids made;
  made.add(24, 0, 0, 20);
  made.add(24, 5, 128, 40);
  made.add(0, 0, 64, 50);
  made.add(6, 0, -1, 50);  // too unlikely
  FindPeople find;
  const TurnedSquare whole = {112 * 256, 112 * 256, 112 * 256, 0};
  const auto found = find(made.grids, whole);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].score_q15, 23955);
  EXPECT_EQ(found[0].region.x_q8, 112 * 256);
  EXPECT_EQ(found[0].region.y_q8, 112 * 256);
  EXPECT_NEAR(found[0].region.right_x_q8, 39.85 * 256, 2);
  EXPECT_EQ(found[0].region.right_y_q8, 0);
  EXPECT_EQ(found[1].region, (TurnedSquare{16 * 256, 16 * 256, 62 * 256 + 128, 0}));
}

/// What the networks say of a body whose points all lie in the crop's middle, cold.
struct BodyResults {
  std::vector<std::int16_t> points = std::vector<std::int16_t>(195), heat = std::vector<std::int16_t>(64 * 64 * 39, -2000),
                            world = std::vector<std::int16_t>(117), presence = {128};
  BodyResults() {
    for (int i = 0; i < 39; ++i) points[5 * i] = points[5 * i + 1] = 128 * 64;
  }
  SeenBody see(const TurnedSquare& region) const {
    return see_body({{points.data(), {1, 1}, 195}, 6}, {{heat.data(), {64, 64}, 39}, 7}, {{world.data(), {1, 1}, 117}, 13},
                    {{presence.data(), {1, 1}, 1}, 7}, region);
  }
};

// By hand, in a region of 512 px around (300, 200): a point at 64 px of the crop lies 128 px left of the middle. Heat in places
// 33 and 34 of row 32, 0.5 and 0.7310586, draws to x = (33 * 16384 + 34 * 23955) / 40339 = 33.594 places = 134.375 px of the
// crop: 12.75 px right.
TEST(SeeBody, HandWorked) {
  BodyResults made;
  const int shoulder = static_cast<int>(BodyPoint::kLeftShoulder), elbow = static_cast<int>(BodyPoint::kLeftElbow);
  made.points[5 * shoulder] = 64 * 64;
  made.points[5 * shoulder + 2] = -32 * 64;
  made.points[5 * shoulder + 3] = 64;
  made.world[3 * shoulder] = 8192 / 2;
  made.heat[(32 * 64 + 33) * 39 + elbow] = 0;
  made.heat[(32 * 64 + 34) * 39 + elbow] = 128;
  made.points[5 * 34 + 1] = 28 * 64;  // the circle: 100 px of the crop above the hips
  const SeenBody body = made.see({300 * 256, 200 * 256, 256 * 256, 0});
  EXPECT_EQ(body.score_q15, 23955);
  EXPECT_EQ(body.at(BodyPoint::kLeftShoulder).x_px(), 300 - 128);
  EXPECT_EQ(body.at(BodyPoint::kLeftShoulder).y_px(), 200);
  EXPECT_EQ(body.at(BodyPoint::kLeftShoulder).z_q8, -64 * 256);
  EXPECT_EQ(body.at(BodyPoint::kLeftShoulder).visible_q15, 23955);
  EXPECT_EQ(body.at(BodyPoint::kLeftShoulder).world_m(), (Vec3{0.5, 0, 0}));
  EXPECT_NEAR(body.at(BodyPoint::kLeftElbow).x_px(), 312.75, 0.01);
  EXPECT_EQ(body.at(BodyPoint::kLeftElbow).y_px(), 200) << "row 32 is the middle";
  EXPECT_EQ(body.next, (TurnedSquare{300 * 256, 200 * 256, 250 * 256, 0})) << "200 px x 1.25";
}

TEST(SeeBody, HeatBelowAHalfDrawsNothing) {
  BodyResults made;
  const int elbow = static_cast<int>(BodyPoint::kLeftElbow);
  made.heat[(32 * 64 + 34) * 39 + elbow] = -1;
  EXPECT_EQ(made.see({300 * 256, 200 * 256, 256 * 256, 0}).at(BodyPoint::kLeftElbow).x_px(), 300);
}

/// Somebody upright: the torso 100 px high and 60 wide in the picture and 0.5 m by 0.3 m, arms down.
SeenBody standing(int x_px, int y_px) {
  SeenBody body;
  body.score_q15 = 32767;
  const auto put = [&](BodyPoint point, double dx, double dy) {
    SeenPoint& p = body.points[static_cast<std::size_t>(point)];
    p.x_q8 = static_cast<std::int32_t>((x_px + dx) * 256);
    p.y_q8 = static_cast<std::int32_t>((y_px + dy) * 256);
    p.world_q16 = {static_cast<std::int32_t>(dx / 200 * 65536), static_cast<std::int32_t>(dy / 200 * 65536), 0};
    p.visible_q15 = 32000;
  };
  using enum BodyPoint;
  for (std::size_t i = 0; i < kBodyPoints; ++i) put(static_cast<BodyPoint>(i), 0, -130);
  put(kLeftShoulder, 30, -100), put(kRightShoulder, -30, -100), put(kLeftHip, 30, 0), put(kRightHip, -30, 0);
  put(kLeftElbow, 40, -50), put(kRightElbow, -40, -50), put(kLeftWrist, 40, 0), put(kRightWrist, -40, 0);
  put(kLeftIndex, 40, 17), put(kLeftPinky, 40, 17), put(kRightIndex, -40, 17), put(kRightPinky, -40, 17);
  for (const BodyPoint foot : {kLeftHeel, kRightHeel, kLeftAnkle, kRightAnkle, kLeftFootIndex, kRightFootIndex})
    put(foot, 0, 180);
  for (const BodyPoint knee : {kLeftKnee, kRightKnee}) put(knee, 0, 90);
  return body;
}

// By hand: 200 px a metre, the knuckles 17 px = 8.5 cm below the wrist: a square of 60 px around them, its right on the
// picture's left.
TEST(HandRegion, HandWorked) {
  const auto region = hand_region(standing(320, 240), true, {640, 480});
  ASSERT_TRUE(region);
  EXPECT_NEAR(region->x_q8 / 256.0, 360, 0.1);
  EXPECT_NEAR(region->y_q8 / 256.0, 257, 0.1);
  EXPECT_NEAR(region->right_x_q8 / 256.0, -30, 0.1);
  EXPECT_NEAR(region->right_y_q8 / 256.0, 0, 0.1);
  EXPECT_FALSE(hand_region(standing(620, 240), true, {640, 480})) << "outside the picture";
}

TEST(PeopleFinder, FollowsTwoWhoMove) {
  TruthDetector detector(0.5);
  PeopleFinder finder(detector, {});
  const Image<Rgb8> picture({640, 480});
  for (int frame = 0; frame < 40; ++frame) {
    const TrueBody bodies[] = {{standing(150 + 4 * frame, 250).points, {}, {}},
                               {standing(500 - 2 * frame, 240).points, {}, {}}};
    detector.show(bodies);
    const auto people = finder.follow(picture.view());
    if (frame < 1) continue;
    ASSERT_EQ(people.size(), 2u) << frame;
    for (const int i : {0, 1}) {
      const double x_px = i == 0 ? 180 + 4 * frame : 530 - 2 * frame;
      EXPECT_NEAR(people[i].body.at(BodyPoint::kLeftShoulder).x_px(), x_px, 6) << frame;
    }
    EXPECT_FALSE(people[0].left_hand);
  }
  detector.show({});
  EXPECT_TRUE(finder.follow(picture.view()).empty());
}

TEST(PeopleFinder, TellsWhoIsWhereInAPictureByItself) {
  TruthDetector detector(0);
  PeopleFinder finder(detector, {.most = 2});
  const TrueBody bodies[] = {
      {standing(150, 250).points, {}, {}}, {standing(300, 250).points, {}, {}}, {standing(500, 250).points, {}, {}}};
  detector.show(bodies);
  const Image<Rgb8> picture({640, 480});
  const auto people = finder.look(picture.view());
  ASSERT_EQ(people.size(), 2u) << "of three, as was asked";
  EXPECT_EQ(people[0].box_px, (Window{110, 120, 81, 311}));
}

TEST(PeopleFinder, AllocatesNothingPerPicture) {
  TruthDetector detector(0.5);
  PeopleFinder finder(detector, {.hands = true});
  const Image<Rgb8> picture({640, 480});
  for (int frame = 0; frame < 40; ++frame) {
    const TrueBody bodies[] = {{standing(150 + 4 * frame, 250).points, {}, {}},
                               {standing(500 - 2 * frame, 240).points, {}, {}}};
    detector.show(bodies);
    const long before = test::allocations;
    finder.follow(picture.view());
    if (frame >= 10) {
      EXPECT_EQ(test::allocations, before) << frame;
    }
  }
}

TEST(NetDetector, AllocatesNothingPerPicture) {
  const auto detector = make_detector({.body = BodyModel::kLite, .hands = true, .threads = 2});
  ASSERT_TRUE(detector) << detector.error().what;
  const Image<Rgb8> picture({320, 240});
  const Look look{picture.view(), {160 * 256, 120 * 256, 100 * 256, 10 * 256}};
  SeenBody body;
  SeenHand hand;
  for (int i = 0; i < 3; ++i) {
    const long before = test::allocations;
    (*detector)->find(picture.view(), Window::all(picture.size()));
    (*detector)->bodies({&look, 1}, {&body, 1});
    (*detector)->hands({&look, 1}, {&hand, 1});
    EXPECT_EQ(test::allocations, before) << i;
  }
}

TEST(TruthDetector, ItsNoiseIsAsWideAsAsked) {
  TruthDetector detector(1);
  const Image<Rgb8> picture({640, 480});
  const TrueBody body{standing(320, 240).points, {}, {}};
  const Look look{picture.view(), {320 * 256, 240 * 256, 256 * 256, 0}};  // two pixels to one of 256
  double square = 0;
  for (int i = 0; i < 100; ++i) {
    detector.show({&body, 1});
    SeenBody seen;
    detector.bodies({&look, 1}, {&seen, 1});
    for (std::size_t k = 0; k < kBodyPoints; ++k) square += std::pow(seen.points[k].x_px() - body.points[k].x_px(), 2);
  }
  EXPECT_NEAR(std::sqrt(square / 100 / kBodyPoints), 2, 0.2);
}

TEST(MakeDetector, AMissingOrForeignNetworkSaysWhatToDo) {
  const auto none = make_detector({.models = "nowhere"});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kNotFound);
  EXPECT_NE(none.error().what.find("tools/models/make person_detector"), std::string::npos) << none.error().what;
}

}  // namespace
}  // namespace duo
