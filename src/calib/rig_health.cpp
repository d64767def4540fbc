#include "duoptic/rig_health.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "calib/rig_formats.h"
#include "calib/scene_pose.h"
#include "duoptic/statistics.h"

namespace duo {
namespace {

constexpr double kLeastCovered = 0.2;

Error scene_error(const std::string& what) { return {ErrorCode::kBadInput, "cannot judge the rig by this scene: " + what}; }

/// Differences of rows, signed, by the part of the left picture that they lie in.
double systematic_row_px(const std::vector<SceneMatch>& matches, const std::vector<double>& errors, Size size) {
  constexpr int kColumns = 4, kRows = 3;
  constexpr std::size_t kFewest = 5;
  std::array<std::vector<double>, kColumns * kRows> parts;
  for (std::size_t i = 0; i < matches.size(); ++i)
    if (std::isfinite(errors[i]))
      parts[static_cast<std::size_t>(cell_of(matches[i].left_px, size, kColumns, kRows))].push_back(errors[i]);
  double sum = 0;
  int count = 0;
  for (const auto& part : parts) {
    if (part.size() < kFewest) continue;
    const double median = quantile(std::vector(part), 0.5);
    sum += median * median;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

/// x_left - x_right of the matches in the common view of a rig, from the nearest to infinity to the nearest to the cameras.
std::vector<double> sorted_disparities_px(const Rig& rig, const std::vector<SceneMatch>& matches) {
  const Vec3 x = normalized(inverse(rig.right_from_left).t_m);
  const Mat3 left_from_right = transposed(rig.right_from_left.rotation);
  const Lens left(rig.left), right(rig.right);
  std::vector<double> out;
  for (const SceneMatch& match : matches) {
    const auto a = left.ray_of(match.left_px), b = right.ray_of(match.right_px);
    if (!a || !b) continue;
    const Vec3 c = left_from_right * *b;
    if (c.z > 0) out.push_back(rig.left.fx_px * dot(*a - (1 / c.z) * c, x));
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// Most points would lie behind the cameras: that is how a pair looks whose pictures are swapped.
///
/// `free` is the pose that the scene gives; of lenses that are a guess it is none, and the cameras are taken to look the same
/// way.
bool swapped(const Rig& rig, const ScenePose& free, const std::vector<SceneMatch>& matches) {
  const std::vector<double> d = sorted_disparities_px(rig.metric ? free.rig : rig, matches);
  if (d.empty()) return false;
  const auto at = [&](double share) { return d[static_cast<std::size_t>(share * static_cast<double>(d.size() - 1))]; };
  return rig.metric ? at(0.5) < -1 - 3 * free.turn_sigma_rad.y * rig.left.fx_px : at(0.9) < -1;
}

/// Two cameras in different places never see all points at the same pixels.
bool one_picture(const std::vector<SceneMatch>& matches) {
  const auto same = std::count_if(matches.begin(), matches.end(), [](const SceneMatch& m) {
    return std::hypot(m.left_px.x - m.right_px.x, m.left_px.y - m.right_px.y) < 0.1;
  });
  return same > 0.9 * static_cast<double>(matches.size());
}

/// Points of a scene that are fit to judge by, and the pose they have if nothing but the lenses is believed.
struct Evidence {
  Size size;
  int pairs = 0;
  bool cut = false;
  std::vector<SceneMatch> matches;
};

Result<Evidence> gather(const Rig& lenses, PairSource& pairs, int threads) {
  const Size size = pairs.size();
  if (!(size == lenses.left.size))
    return scene_error(fmt::format("the pictures are {}x{}, the rig is for {}x{}; use the size it was calibrated at",
                                   size.width, size.height, lenses.left.size.width, lenses.left.size.height));
  DUO_TRY_ASSIGN(const SceneMatches scene, match_scene(pairs, threads));
  Evidence evidence{size, scene.pairs, scene.cut, {}};
  DUO_TRY_ASSIGN(evidence.matches, agreeing_matches(lenses, scene));
  if (one_picture(evidence.matches)) return scene_error("left and right are the same picture; give one of each camera");
  const double covered = covered_share(evidence.matches, size);
  const std::string missing = missing_parts(evidence.matches, size);
  if (covered < kLeastCovered)
    return scene_error(fmt::format("its {} points cover only {:.0f} % of the picture{}; choose one with texture all over",
                                   evidence.matches.size(), 100 * covered,
                                   missing.empty() ? "" : " (none in " + missing + ")"));
  return evidence;
}

/// By how many standard deviations the scene has another pan than the rig.
double pan_sigmas(const SceneHealth& health) {
  return std::abs(health.turned_rad.y) / std::max(1e-12, health.turned_sigma_rad.y);
}

/// A pan counts when the scene is sure of it: small errors of lenses look the same.
bool sure_of_pan(const SceneHealth& health) { return pan_sigmas(health) > 4; }

RigVerdict verdict_of(const SceneHealth& health, bool metric) {
  constexpr double kGoodPan_px = 0.5, kUselessPan_px = 2, kDoubtedPan_sigmas = 2.5;
  const bool sure = metric && sure_of_pan(health);
  if (health.row_px >= kUselessRow_px || (sure && health.pan_px >= kUselessPan_px)) return RigVerdict::kRecalibrate;
  if (health.row_px >= kGoodRow_px || (sure && health.pan_px >= kGoodPan_px)) return RigVerdict::kCanBeImproved;
  // Not sure, but enough to spoil every depth if it is true: no rig to call good.
  if (metric && pan_sigmas(health) > kDoubtedPan_sigmas && health.pan_px >= kUselessPan_px) return RigVerdict::kCanBeImproved;
  return RigVerdict::kGood;
}

Result<SceneHealth> judge(const Rig& rig, const Evidence& evidence) {
  DUO_TRY_ASSIGN(const ScenePose free, fit_scene_pose(rig, kFreePose, evidence.matches, evidence.pairs));
  if (swapped(rig, free, evidence.matches))
    return Error{ErrorCode::kBadInput,
                 "left and right are swapped: most points would lie behind the cameras; give the pictures in the other order"};
  const std::vector<double> errors = row_errors_px(rig, evidence.matches);
  std::vector<double> sizes;
  for (const double error : errors)
    if (std::isfinite(error)) sizes.push_back(std::abs(error));
  SceneHealth health;
  health.pairs = evidence.pairs;
  health.cut = evidence.cut;
  health.points = static_cast<int>(evidence.matches.size());
  health.covered = covered_share(evidence.matches, evidence.size);
  health.missing = missing_parts(evidence.matches, evidence.size);
  health.row_px = systematic_row_px(evidence.matches, errors, evidence.size);
  health.row_median_px = quantile(sizes, 0.5);
  health.row_p95_px = quantile(sizes, 0.95);
  health.turned_rad = free.turned_rad;
  health.turned_sigma_rad = free.turn_sigma_rad;
  health.pan_px = std::abs(free.turned_rad.y) * rig.left.fx_px;
  health.pan_sigma_px = free.turn_sigma_rad.y * rig.left.fx_px;
  health.verdict = verdict_of(health, rig.metric);
  return health;
}

/// The pose that the scene gives, in a rig that forgets what its calibration said of the old one.
Result<SceneRig> with_pose(const Rig& start, const SceneHealth& before, const SceneFreedom& freedom, const Evidence& evidence) {
  DUO_TRY_ASSIGN(const ScenePose pose, fit_scene_pose(start, freedom, evidence.matches, evidence.pairs));
  SceneRig out{pose.rig, before, {}};
  out.rig.reprojection_rms_px = 0;
  out.rig.errors = {};
  out.rig.errors.row_px = pose.row_rms_px;
  out.rig.uncertainty.reset();
  DUO_TRY(check_rig(out.rig, "rig found in the scene"));
  DUO_TRY_ASSIGN(out.after, judge(out.rig, evidence));
  return out;
}

/// Two webcams side by side, of which nothing is known.
Rig guessed_rig(Size size) {
  constexpr double kFocalOfWidth = 0.9;  // a field of view of 58 degrees
  Rig rig;
  rig.left = rig.right = {.size = size,
                          .fx_px = kFocalOfWidth * size.width,
                          .fy_px = kFocalOfWidth * size.width,
                          .cx_px = (size.width - 1) / 2.0,
                          .cy_px = (size.height - 1) / 2.0};
  rig.metric = false;
  return rig;
}

}  // namespace

Result<SceneHealth> scene_health(const Rig& rig, PairSource& pairs, int threads) {
  DUO_TRY_ASSIGN(const Evidence evidence, gather(rig, pairs, threads));
  return judge(rig, evidence);
}

Result<SceneRig> refine_rig(const Rig& rig, PairSource& pairs, int threads) {
  DUO_TRY_ASSIGN(const Evidence evidence, gather(rig, pairs, threads));
  DUO_TRY_ASSIGN(const SceneHealth before, judge(rig, evidence));
  if (before.verdict == RigVerdict::kGood) return SceneRig{rig, before, before};
  return with_pose(rig, before, sure_of_pan(before) ? kFreePose : kNudged, evidence);
}

Result<SceneRig> rig_from_scene(const std::optional<Rig>& lenses, double baseline_m, PairSource& pairs, int threads) {
  Rig start = lenses ? *lenses : guessed_rig(pairs.size());
  start.right_from_left = {{}, {-baseline_m, 0, 0}};
  DUO_TRY_ASSIGN(const Evidence evidence, gather(start, pairs, threads));
  DUO_TRY_ASSIGN(const SceneHealth before, judge(start, evidence));
  return with_pose(start, before, lenses ? kFreePose : kFreePoseAndLens, evidence);
}

}  // namespace duo
