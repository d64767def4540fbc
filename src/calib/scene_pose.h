// The pose of a rig from points of a scene, in place of a board.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "calib/scene_matches.h"
#include "duoptic/rig.h"

namespace duo {

/// What the points may change of a rig: turns of the cameras around their own axes x (tilt), y (pan), z (roll), which are the
/// five degrees of a pose whose baseline has a known length (tilting both cameras changes nothing), and of both lenses alike
/// the focal length and k1.
enum ScenePart : std::uint8_t { kTilt, kLeftPan, kRightPan, kLeftRoll, kRightRoll, kFocal, kFocalRatio, kBend, kSceneParts };

/// How far each part may lie from the start: one standard deviation; 0 holds it.
///
/// Units  turns in rad; focal lengths: of the logarithm; bend: of k1
using SceneFreedom = std::array<double, kSceneParts>;

/// Nothing is known but that the cameras stand side by side: the pose is found with the given lenses.
inline constexpr SceneFreedom kFreePose = {0.5, 0.3, 0.3, 0.3, 0.3, 0, 0, 0};
/// The same with lenses that nobody knows: a field of view as webcams have, a little distortion, axes nearly parallel.
inline constexpr SceneFreedom kFreePoseAndLens = {0.5, 0.03, 0.03, 0.3, 0.3, 0.1, 0.02, 0.1};
/// One camera was turned around its own centre, which leaves the baseline where it was in the other's picture: three unknowns
/// instead of five, and a pan that few points know better.
inline constexpr SceneFreedom kLeftTurned = {0.5, 0.3, 0, 0.3, 0, 0, 0, 0}, kRightTurned = {0.5, 0, 0.3, 0, 0.3, 0, 0, 0};
/// A rig that was good and got a push. Points see tilt and roll well; a pan they see badly, and a wrong one spoils every depth.
inline constexpr SceneFreedom kNudged = {0.5, 0.0005, 0.0005, 0.5, 0.5, 0, 0, 0};

struct ScenePose {
  Rig rig;
  int used = 0;           // matches that agree with it
  double row_rms_px = 0;  // of them
  Vec3 turned_rad;        // from the start, of the right camera to the left, around its x, y, z
  Vec3 turn_sigma_rad;    // of the right camera to the left, around x, y, z
};

/// Matches that some fundamental matrix explains: all lenses of the rig undone, nothing of its pose assumed.
///
/// Errors  too few
/// Source  Barath, Noskova, Ivashechkin, Matas, "MAGSAC++, a fast, reliable and accurate robust estimator", 2020 (OpenCV's)
Result<std::vector<SceneMatch>> agreeing_matches(const Rig& lenses, const SceneMatches& scene);

/// The rig nearest to `start` that fits the matches: Gauss-Newton on Sampson's distance with Tukey's weights. The baseline
/// keeps its length. So many matches count as one against the freedom: all pairs may show one still scene with the same points.
/// The uncertainty is that of the matches' noise, and of what a calibration leaves of the lenses. Where lenses are free, what
/// is not known of their shape makes errors alike in whole parts of the picture: then all matches weigh as fifty.
///
/// `neighbours_alike`: there are no repeated pairs, but neighbours share pixels, so many of them count as one, against noise
/// too.
///
/// Errors  the numbers run away
/// Source  Hartley, Zisserman, "Multiple View Geometry", 2004, section 11.4.3 (distance); Tukey's biweight at 95 % efficiency
Result<ScenePose> fit_scene_pose(const Rig& start, const SceneFreedom& freedom, const std::vector<SceneMatch>& matches,
                                 int as_one, bool neighbours_alike = false);

/// Sampson's distance of each match, times sqrt 2: the difference of rows in a rectified pair. NaN where a lens sees no ray.
///
/// Units  px of the raw pictures
std::vector<double> row_errors_px(const Rig& rig, const std::vector<SceneMatch>& matches);

}  // namespace duo
