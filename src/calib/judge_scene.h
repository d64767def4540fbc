// What points of a scene say of a rig.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/scene_matches.h"
#include "calib/scene_pose.h"
#include "duoptic/rig_health.h"

namespace duo {

/// Points of a scene that are fit to judge by.
struct Evidence {
  Size size;
  int pairs = 0;
  bool cut = false;
  std::vector<SceneMatch> matches;
  int as_one = 1;           // so many matches count as one: of one point in all pairs, or of patches that share pixels
  bool of_patches = false;  // such patches
};

/// Two webcams side by side, of which nothing is known; not metric.
Rig guessed_rig(Size size);

/// Errors  pictures of another size than the lenses'
Result<void> check_size(const Rig& lenses, Size size);

/// `matches`: those of the scene that agree.
///
/// Errors  all in one corner; the same picture twice
Result<Evidence> evidence_of(const SceneMatches& scene, std::vector<SceneMatch> matches);

/// x_left - x_right, in px of the left lens, of points that both pictures of a pair show, sorted; empty where too few agree. Of
/// a pair without a rig, which is taken as rectified, those of its pixels.
std::vector<double> seen_disparities_px(const std::optional<Rig>& rig, const Pair& pair);

/// Two cameras in different places never see nearly all points at the same pixels.
bool one_picture(const std::vector<SceneMatch>& matches);

/// `pose_known`: false where the rig's pose is still to be found.
///
/// Errors  left and right swapped, or both mirrored
Result<SceneHealth> judge_scene(const Rig& rig, const Evidence& evidence, bool pose_known = true);

/// What a pose that fits the points says of the rig, in place of another's: all figures but the rows of the rig as it is.
void take_pose(const Rig& rig, const ScenePose& pose, const Evidence& evidence, SceneHealth& health);

/// A pan counts when the scene is sure of it: small errors of lenses look the same.
bool sure_of_pan(const SceneHealth& health);

}  // namespace duo
