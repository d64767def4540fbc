#include "calib/judge_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "calib/rig_size.h"
#include "duoptic/statistics.h"

namespace duo {
namespace {

constexpr double kLeastCovered = 0.2;

Error scene_error(const std::string& what) { return {ErrorCode::kBadInput, "cannot judge the rig by this scene: " + what}; }

/// Differences of rows, signed, by the part of the left picture that they lie in: their medians' root mean square, less what
/// medians of so few points have by noise alone. The pairs of a still scene show the same points: they count once. The worst
/// part does not count: a few wrong matches, or somebody who moved between two shutters, make the rows of one part wrong, a
/// camera that was turned those of all.
double systematic_row_px(const Evidence& evidence, const std::vector<double>& errors) {
  constexpr int kColumns = 4, kRows = 3;
  constexpr std::size_t kFewest = 5, kFewestParts = 4;
  constexpr double kMedianVariance = 1.57;  // pi / 2: of a normal distribution, in sigma^2 / n
  std::array<std::vector<double>, kColumns * kRows> parts;
  for (std::size_t i = 0; i < errors.size(); ++i)
    if (std::isfinite(errors[i]))
      parts[static_cast<std::size_t>(cell_of(evidence.matches[i].left_px, evidence.size, kColumns, kRows))].push_back(
          errors[i]);
  std::vector<double> squares;
  for (const auto& part : parts) {
    if (part.size() < kFewest) continue;
    const double middle = quantile(std::vector(part), 0.5);
    std::vector<double> off;
    for (const double error : part) off.push_back(std::abs(error - middle));
    const double sigma_px = 1.4826 * quantile(off, 0.5), points = static_cast<double>(part.size()) / evidence.as_one;
    squares.push_back(middle * middle - kMedianVariance * sigma_px * sigma_px / std::max(1.0, points));
  }
  if (squares.empty()) return 0;
  if (squares.size() >= kFewestParts) squares.erase(std::max_element(squares.begin(), squares.end()));
  double sum = 0;
  for (const double square : squares) sum += square;
  return std::sqrt(std::max(0.0, sum) / static_cast<double>(squares.size()));
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

/// Most points would lie behind the cameras: that is how a pair looks whose pictures are swapped, or both mirrored.
///
/// `free` is the pose that the scene gives; of lenses that are a guess it is none, and the cameras are taken to look the same
/// way.
bool behind(const Rig& rig, const ScenePose& free, const std::vector<SceneMatch>& matches) {
  const std::vector<double> d = sorted_disparities_px(rig.metric ? free.rig : rig, matches);
  if (d.empty()) return false;
  const auto at = [&](double share) { return d[static_cast<std::size_t>(share * static_cast<double>(d.size() - 1))]; };
  return rig.metric ? at(0.5) < -1 - 3 * free.turn_sigma_rad.y * rig.left.fx_px : at(0.9) < -1;
}

/// Which of both it is, where the rows fit the rig clearly better once the one is undone than once the other is; empty where
/// they fit with neither: then it is the rig that is wrong.
std::string why_behind(const Rig& rig, const Evidence& evidence, bool pose_known) {
  constexpr double kClearly = 1.5, kFits_px = 2;
  const double last = evidence.size.width - 1;
  std::vector<SceneMatch> swapped, mirrored;
  for (const SceneMatch& m : evidence.matches) {
    swapped.push_back({m.right_px, m.left_px});
    mirrored.push_back({{last - m.left_px.x, m.left_px.y}, {last - m.right_px.x, m.right_px.y}});
  }
  const auto off_px = [&](const std::vector<SceneMatch>& matches) {
    std::vector<double> off;
    for (const double error : row_errors_px(rig, matches))
      if (std::isfinite(error)) off.push_back(std::abs(error));
    return off.empty() ? 1e9 : quantile(off, 0.5);
  };
  const double by_swap_px = off_px(swapped), by_mirror_px = off_px(mirrored);
  if (rig.metric && pose_known && std::min(by_swap_px, by_mirror_px) > kFits_px) return {};
  const char *swap = "give the pictures in the other order", *mirror = "switch the mirroring of the cameras off",
             *behind = "most points would lie behind the cameras";
  if (rig.metric && by_mirror_px > kClearly * by_swap_px)
    return fmt::format("left and right are swapped: {}; {}", behind, swap);
  if (rig.metric && by_swap_px > kClearly * by_mirror_px)
    return fmt::format("both pictures are mirrored: {}; {}", behind, mirror);
  return fmt::format("left and right are swapped, or both pictures are mirrored: {}; {}, or {}", behind, swap, mirror);
}

/// By how many standard deviations the scene has another pan than the rig.
double pan_sigmas(const SceneHealth& health) {
  return std::abs(health.turned_rad.y) / std::max(1e-12, health.turned_sigma_rad.y);
}

RigVerdict verdict_of(const SceneHealth& health, bool metric) {
  constexpr double kGoodPan_px = 0.5, kUselessPan_px = 2, kDoubtedPan_sigmas = 2.5;
  const bool sure = metric && sure_of_pan(health);
  if (health.row_px >= kUselessRow_px || (sure && health.pan_px >= kUselessPan_px)) return RigVerdict::kRecalibrate;
  if (health.row_px >= kGoodRow_px || (sure && health.pan_px >= kGoodPan_px)) return RigVerdict::kCanBeImproved;
  // Not sure, but enough to spoil every depth if it is true: no rig to call good.
  if (metric && pan_sigmas(health) > kDoubtedPan_sigmas && health.pan_px >= kUselessPan_px) return RigVerdict::kCanBeImproved;
  return RigVerdict::kGood;
}

}  // namespace

bool sure_of_pan(const SceneHealth& health) { return pan_sigmas(health) > 4; }

bool one_picture(const std::vector<SceneMatch>& matches) {
  const auto same = std::count_if(matches.begin(), matches.end(), [](const SceneMatch& m) {
    return std::hypot(m.left_px.x - m.right_px.x, m.left_px.y - m.right_px.y) < 0.1;
  });
  return !matches.empty() && same > 0.9 * static_cast<double>(matches.size());
}

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

std::vector<double> seen_disparities_px(const std::optional<Rig>& rig, const Pair& pair) {
  const auto matches =
      agreeing_matches(rig ? *rig : guessed_rig(pair.left.pixels.size()), match_pair(pair, 1, SceneSearch::kQuick));
  if (!matches) return {};
  if (rig) return sorted_disparities_px(*rig, *matches);
  std::vector<double> out;
  for (const SceneMatch& match : *matches) out.push_back(match.left_px.x - match.right_px.x);
  std::sort(out.begin(), out.end());
  return out;
}

Result<void> check_size(const Rig& lenses, Size size) {
  const std::string why = why_other_size(lenses, size);
  return why.empty() ? Result<void>() : scene_error(why);
}

Result<Evidence> evidence_of(const SceneMatches& scene, std::vector<SceneMatch> matches) {
  const bool of_patches = scene.share_pixels > 0;
  Evidence evidence{scene.size, scene.pairs, scene.cut, std::move(matches), of_patches ? scene.share_pixels : scene.pairs,
                    of_patches};
  if (one_picture(evidence.matches)) return scene_error("left and right are the same picture; give one of each camera");
  const double covered = covered_share(evidence.matches, scene.size);
  const std::string missing = missing_parts(evidence.matches, scene.size);
  if (covered < kLeastCovered)
    return scene_error(fmt::format("its {} points cover only {:.0f} % of the picture{}; choose one with texture all over",
                                   evidence.matches.size(), 100 * covered,
                                   missing.empty() ? "" : " (none in " + missing + ")"));
  return evidence;
}

void take_pose(const Rig& rig, const ScenePose& pose, const Evidence& evidence, SceneHealth& health) {
  health.turned_rad = pose.turned_rad;
  health.turned_sigma_rad = pose.turn_sigma_rad;
  health.pan_px = std::abs(pose.turned_rad.y) * rig.left.fx_px;
  health.pan_sigma_px = pose.turn_sigma_rad.y * rig.left.fx_px;
  health.lens_row_px = systematic_row_px(evidence, row_errors_px(pose.rig, evidence.matches));
}

Result<SceneHealth> judge_scene(const Rig& rig, const Evidence& evidence, bool pose_known) {
  DUO_TRY_ASSIGN(const ScenePose free, fit_scene_pose(rig, kFreePose, evidence.matches, evidence.as_one, evidence.of_patches));
  if (behind(rig, free, evidence.matches))
    if (std::string why = why_behind(rig, evidence, pose_known); !why.empty())
      return Error{ErrorCode::kBadInput, std::move(why)};
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
  health.row_px = systematic_row_px(evidence, errors);
  health.row_median_px = quantile(sizes, 0.5);
  health.row_p95_px = quantile(sizes, 0.95);
  take_pose(rig, free, evidence, health);
  health.verdict = verdict_of(health, rig.metric);
  return health;
}

}  // namespace duo
