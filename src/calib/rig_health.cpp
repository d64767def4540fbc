#include "duoptic/rig_health.h"

#include <utility>

#include "calib/judge_scene.h"
#include "calib/rig_formats.h"
#include "calib/scene_pose.h"

namespace duo {
namespace {

Result<Evidence> evidence(const Rig& lenses, PairSource& pairs, int threads) {
  DUO_TRY(check_size(lenses, pairs.size()));
  DUO_TRY_ASSIGN(const SceneMatches scene, match_scene(pairs, threads));
  DUO_TRY_ASSIGN(std::vector<SceneMatch> matches, agreeing_matches(lenses, scene));
  return evidence_of(scene, std::move(matches));
}

/// The pose that the scene gives, in a rig that forgets what its calibration said of the old one.
Result<SceneRig> with_pose(const Rig& start, const SceneHealth& before, const SceneFreedom& freedom, const Evidence& seen) {
  DUO_TRY_ASSIGN(const ScenePose pose, fit_scene_pose(start, freedom, seen.matches, seen.as_one));
  SceneRig out{pose.rig, before, {}};
  out.rig.reprojection_rms_px = 0;
  out.rig.errors = {};
  out.rig.errors.row_px = pose.row_rms_px;
  out.rig.uncertainty.reset();
  DUO_TRY(check_rig(out.rig, "rig found in the scene"));
  DUO_TRY_ASSIGN(out.after, judge_scene(out.rig, seen));
  return out;
}

}  // namespace

Result<SceneHealth> scene_health(const Rig& rig, PairSource& pairs, int threads) {
  DUO_TRY_ASSIGN(const Evidence seen, evidence(rig, pairs, threads));
  return judge_scene(rig, seen);
}

Result<SceneRig> refine_rig(const Rig& rig, PairSource& pairs, int threads) {
  DUO_TRY_ASSIGN(const Evidence seen, evidence(rig, pairs, threads));
  DUO_TRY_ASSIGN(const SceneHealth before, judge_scene(rig, seen));
  if (before.verdict == RigVerdict::kGood) return SceneRig{rig, before, before};
  return with_pose(rig, before, sure_of_pan(before) ? kFreePose : kNudged, seen);
}

Result<SceneRig> rig_from_scene(const std::optional<Rig>& lenses, double baseline_m, PairSource& pairs, int threads) {
  Rig start = lenses ? *lenses : guessed_rig(pairs.size());
  start.right_from_left = {{}, {-baseline_m, 0, 0}};
  DUO_TRY_ASSIGN(const Evidence seen, evidence(start, pairs, threads));
  DUO_TRY_ASSIGN(const SceneHealth before, judge_scene(start, seen, false));
  return with_pose(start, before, lenses ? kFreePose : kFreePoseAndLens, seen);
}

}  // namespace duo
