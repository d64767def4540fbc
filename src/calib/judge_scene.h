// What points of a scene say of a rig.
#pragma once

#include <string>
#include <vector>

#include "calib/scene_matches.h"
#include "duoptic/rig_health.h"

namespace duo {

/// Points of a scene that are fit to judge by.
struct Evidence {
  Size size;
  int pairs = 0;
  bool cut = false;
  std::vector<SceneMatch> matches;
};

/// Two webcams side by side, of which nothing is known; not metric.
Rig guessed_rig(Size size);

/// Errors  pictures of another size than the lenses'
Result<void> check_size(const Rig& lenses, Size size);

/// `matches`: those of the scene that agree.
///
/// Errors  all in one corner; the same picture twice
Result<Evidence> evidence_of(const SceneMatches& scene, std::vector<SceneMatch> matches);

/// Two cameras in different places never see nearly all points at the same pixels.
bool one_picture(const std::vector<SceneMatch>& matches);

/// `pose_known`: false where the rig's pose is still to be found.
///
/// Errors  left and right swapped, or both mirrored
Result<SceneHealth> judge_scene(const Rig& rig, const Evidence& evidence, bool pose_known = true);

/// A pan counts when the scene is sure of it: small errors of lenses look the same.
bool sure_of_pan(const SceneHealth& health);

}  // namespace duo
