// How good a rig is, and putting one right: from its numbers alone, and from any scene that both cameras see.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "duoptic/rig.h"
#include "duoptic/source.h"

namespace [[gnu::visibility("default")]] duo {

enum class RigVerdict : std::uint8_t { kGood, kCanBeImproved, kRecalibrate };

/// "good", "can be improved", "recalibrate".
const char* name_of(RigVerdict verdict);

/// What is doubtful about the numbers of a rig that check_rig() accepts.
struct RigDoubt {
  RigVerdict verdict;  // what it makes of the rig at best
  std::string what;    // one line: what is wrong, and by how much
};

/// Lenses that turn back inside the picture or bend it a lot, focal lengths and centres that no webcam has, cameras that look
/// apart (a mirrored pose), views without common part, a calibration that fitted badly.
std::vector<RigDoubt> rig_doubts(const Rig& rig);

/// What a scene says of a rig. Its points are matched without the rig; then their rows are compared.
///
/// Units  px of the raw pictures
struct SceneHealth {
  RigVerdict verdict = RigVerdict::kGood;
  int pairs = 0, points = 0;  // pictures looked at, points that agree with each other
  double covered = 0;         // share of the picture that has points, 0 .. 1
  std::string missing;        // parts that have none, in words; empty when all have
  double row_px = 0;          // difference of rows that is no noise: of medians in parts of the picture, of four or more
                              // without the worst, root mean square
  double lens_row_px = 0;     // what of it no turn of the cameras takes away: the lenses, or the zoom, are others
  double row_median_px = 0, row_p95_px = 0;  // of single points, noise and wrong matches included
  Vec3 turned_rad, turned_sigma_rad;         // how the right camera is turned from where the rig has it, around its x, y, z
  double pan_px = 0, pan_sigma_px = 0;       // what of that shifts all disparities, at the focal length
  bool cut = false;                          // the stream was cut short; its whole pairs were used
};

/// The worst of all; `scene`: null where none was looked at.
RigVerdict overall(const std::vector<RigDoubt>& doubts, const SceneHealth* scene);

/// `row_px` below this is good, from the other on useless for matching.
inline constexpr double kGoodRow_px = 0.25, kUselessRow_px = 0.75;

/// Errors  the stream's; pictures of another size than the rig's; too few points or all in one corner; left and right swapped
Result<SceneHealth> scene_health(const Rig& rig, PairSource& pairs, int threads);

/// A rig from a scene, with what the scene says of it and of the one before.
struct SceneRig {
  Rig rig;
  SceneHealth before, after;
};

/// A nudged rig put right. Tilt and roll are free; pan, which a scene shows badly and which spoils depth, has a strong prior
/// unless the scene is sure of it. The baseline keeps its length and the lenses stay as they are; a rig that is good is
/// returned as it was.
///
/// Errors  those of scene_health()
/// Source  Hansen, Alismail, Rander, Browning, "Online continuous stereo extrinsic parameter estimation", 2012
Result<SceneRig> refine_rig(const Rig& rig, PairSource& pairs, int threads);

/// A rig without a board. With `lenses` (a rig of which only the cameras are used) it is metric: all but the length of the
/// baseline is seen in the scene. Without, both lenses are taken for a webcam's and fitted as far as the rows tell: rows agree,
/// disparities and their order are right, distances are not, and the rig says so (metric = false).
///
/// Errors  those of scene_health()
Result<SceneRig> rig_from_scene(const std::optional<Rig>& lenses, double baseline_m, PairSource& pairs, int threads);

}  // namespace duo
