#include "trackers/thesis/place_joints.h"

#include <gtest/gtest.h>

#include "duoptic/image.h"

namespace duo {
namespace {

/// Points at whole places, each matched by the stored one of the same number.
struct Points {
  SiftPoints seen{8};
  std::vector<PointMatch> matches;
  std::vector<PlaceQ4> to_joint;

  Points& add(float x_px, float y_px, PlaceQ4 way) {
    seen[seen.count].x_px = x_px;
    seen[seen.count].y_px = y_px;
    matches.push_back({seen.count++, 0});
    to_joint.push_back(way);
    return *this;
  }
  JointEvidence with(const AreaSums& color, PlaceQ4 expected = {160, 160}) const {
    return {expected, &color, &seen, matches, to_joint};
  }
};

class PlaceJoint : public testing::Test {
 protected:
  PlaceJoint() {
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 30; ++x) d_q4_.at(y, x) = static_cast<std::uint16_t>(100 * y + x);
  }
  Image<std::uint16_t> d_q4_{{30, 20}};
  AreaSums nothing_, blob_{.count = 12, .x = 12 * 5 + 1, .y = 12 * 9 - 1};  // means 5 1/12 and 8 11/12: 81.3 and 142.7 of 16
};

// By hand: 1/16 px, rounded; pixel (9, 5).
TEST_F(PlaceJoint, ByColor) {
  EXPECT_EQ(ref::place_joint(Points().with(blob_), d_q4_), (ObservedJoint{{81, 143}, kSeenByColor, 905}));
  AreaSums small = blob_;
  small.count = 11;
  EXPECT_EQ(ref::place_joint(Points().with(small), d_q4_), (ObservedJoint{{160, 160}, 0, 1010})) << "too few pixels";
}

// By hand: the votes are x 48 64 320 and y -16 0 32 in order.
TEST_F(PlaceJoint, ByPoints) {
  Points points;
  points.add(2, 1, {16, 16}).add(20, 1, {0, -16});
  EXPECT_EQ(ref::place_joint(points.with(nothing_), d_q4_).seen_by, 0u) << "two are no vote";
  points.add(4, 0, {0, -16});
  EXPECT_EQ(ref::place_joint(points.with(nothing_), d_q4_), (ObservedJoint{{64, 0}, kSeenByPoints, 4}));
  points.matches[1].seen = PointMatch::kNone;
  EXPECT_EQ(ref::place_joint(points.with(nothing_), d_q4_).seen_by, 0u);
}

// Of four votes the third; 1/32 px goes to the next 1/16.
TEST_F(PlaceJoint, MedianOfAnEvenNumber) {
  Points points;
  for (const float x : {1.0f, 2.0f, 3.03125f, 4.0f}) points.add(x, 7, {});
  EXPECT_EQ(ref::place_joint(points.with(nothing_), d_q4_).at, (PlaceQ4{49, 112}));
}

// By hand: (81 + 50) / 2 and (143 + -200) / 2, both down; above the picture there is no disparity.
TEST_F(PlaceJoint, BothMeetHalfWay) {
  Points points;
  for (int i = 0; i < 3; ++i) points.add(3, -12, {2, -8});
  EXPECT_EQ(ref::place_joint(points.with(blob_), d_q4_),
            (ObservedJoint{{65, -29}, kSeenByColor | kSeenByPoints, Disparity::kNone}));
}

TEST_F(PlaceJoint, OutsideIsNoDisparity) {
  const auto d_at = [&](PlaceQ4 at) { return ref::place_joint(Points().with(nothing_, at), d_q4_).d_q4; };
  EXPECT_EQ(d_at({29 * 16 + 7, 19 * 16 + 7}), 1929u);
  EXPECT_EQ(d_at({29 * 16 + 8, 19 * 16}), Disparity::kNone);
  EXPECT_EQ(d_at({0, 19 * 16 + 8}), Disparity::kNone);
  EXPECT_EQ(d_at({-8, -8}), 0u);
  EXPECT_EQ(d_at({-9, 0}), Disparity::kNone);
}

}  // namespace
}  // namespace duo
