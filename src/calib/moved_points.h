// Things that moved between the two photos of a pair.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/scene_matches.h"
#include "duoptic/rig.h"

namespace duo {

/// A value of the matches by a plane over the left picture: a constant, per column, per row.
struct MatchPlane {
  double constant = 0, per_column = 0, per_row = 0;
  double at(Vec2 left_px) const { return constant + per_column * left_px.x + per_row * left_px.y; }
};
/// Least squares.
MatchPlane plane_of(const std::vector<SceneMatch>& matches, double (*value)(const SceneMatch&));

/// Neighbouring points that look alike in both photos and lie off their rows by the same: a thing that was elsewhere when the
/// second was taken. What moved along its row cannot be told from what is nearer or farther. What looks nearly as much alike on
/// its own row did not move, but stands there more than once, as windows do.
///
/// `agreeing`  of the scene's matches those that one pose of the cameras explains
/// Returns     one line; empty: nothing is known to have moved
std::string why_moved(const std::optional<Rig>& rig, const SceneMatches& scene, const std::vector<SceneMatch>& agreeing,
                      const Pair& pair);

}  // namespace duo
