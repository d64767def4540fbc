// What stands before a person, told from its own legs.
#include "trackers/body/hidden_by.h"

#include <gtest/gtest.h>

#include "trackers/body/standing.h"

namespace duo::body {
namespace {

using enum JointId;

constexpr double kSkin_m = 1.9, kNearer_m = 1.4;
constexpr int kHips_px = 127, kKnees_px = 208;  // rows

/// Somebody who stands two metres away before a room; hips and knees are marked on whatever is there.
struct StandsBehind : test::Standing {
  test::Map map_of_depth;
  StandsBehind() : Standing(test::standing()) {
    map_of_depth.fill({0, 0, 320, 240}, 4);
    map_of_depth.fill({125, 25, 70, 215}, kSkin_m);
    scene.depth = map_of_depth.view();
    scene.trunk_z_m = kSkin_m;
  }
  void mark(double z_m) {
    for (const JointId id : {kLeftHip, kRightHip, kLeftKnee, kRightKnee}) put(id, {{z_m, 1}});
    mark_what_hides(scene);
  }
  bool is_hidden(JointId id) const { return scene.surfaces[id].all[0].hides; }
};

TEST(BodyHiddenBy, AChairBeforeSomebodyIsNoLap) {
  StandsBehind s;
  s.map_of_depth.fill({110, kHips_px - 10, 100, 240 - (kHips_px - 10)}, kNearer_m);
  s.mark(kNearer_m);
  for (const JointId id : {kLeftHip, kRightHip, kLeftKnee, kRightKnee}) EXPECT_TRUE(s.is_hidden(id)) << name_of(id);
}

TEST(BodyHiddenBy, WhatShowsUnderATableIsNotHidden) {
  StandsBehind s;
  s.map_of_depth.fill({20, kHips_px - 10, 280, 30}, kNearer_m);
  for (const JointId id : {kLeftHip, kRightHip}) s.put(id, {{kNearer_m, 1}});
  for (const JointId id : {kLeftKnee, kRightKnee}) s.put(id, {{kSkin_m, 1}});
  mark_what_hides(s.scene);
  for (const JointId id : {kLeftHip, kRightHip}) EXPECT_TRUE(s.is_hidden(id)) << name_of(id);
  for (const JointId id : {kLeftKnee, kRightKnee}) EXPECT_FALSE(s.is_hidden(id)) << name_of(id);
}

// Thighs that point at the cameras: nearer by half a metre, row by row.
TEST(BodyHiddenBy, KneesOfWhoSitsAreNot) {
  StandsBehind s;
  for (int y = kHips_px; y < 240; ++y)
    s.map_of_depth.fill({100, y, 120, 1}, std::max(kSkin_m - 0.5 * (y - kHips_px) / (kKnees_px - kHips_px), kNearer_m));
  s.mark(kNearer_m);
  for (const JointId id : {kLeftKnee, kRightKnee}) EXPECT_FALSE(s.is_hidden(id)) << name_of(id);
}

// A hand held before the trunk begins with a step, too, but is no wider than a hand.
TEST(BodyHiddenBy, AHandBeforeTheTrunkIsNotButBehindABoardItIs) {
  for (const bool board : {false, true}) {
    StandsBehind s;
    s.map_of_depth.fill(board ? Window{110, 100, 130, 140} : Window{196, 110, 30, 40}, kNearer_m);
    s.put(kLeftWrist, {{kNearer_m, 1}});
    mark_what_hides(s.scene);
    EXPECT_EQ(s.is_hidden(kLeftWrist), board);
  }
}

}  // namespace
}  // namespace duo::body
