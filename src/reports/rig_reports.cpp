#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "duoptic/reports.h"
#include "reports/report_json.h"

namespace duo {
namespace {

constexpr double kDeg = 180 / std::numbers::pi;

/// Turns around x, y, z of a rotation that is not large.
Vec3 turns_deg(const Mat3& r) { return (kDeg / 2) * Vec3{r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1)}; }

nlohmann::json list(Vec3 v) { return {v.x, v.y, v.z}; }

}  // namespace

std::string text_of(const Rig& rig) {
  const Vec3 turns = turns_deg(rig.right_from_left.rotation);
  return fmt::format(
      "{}x{}, focal lengths {:.1f} and {:.1f} px, {:.1f} mm apart{}, right camera turned by tilt {:.2f}, pan {:.2f}, roll "
      "{:.2f} "
      "degrees",
      rig.left.size.width, rig.left.size.height, rig.left.fx_px, rig.right.fx_px, 1000 * rig.baseline_m(),
      rig.metric ? "" : " (a guess: the rig is not metric)", turns.x, turns.y, turns.z);
}

nlohmann::json report_json(const Rig& rig) {
  return {{"width", rig.left.size.width},
          {"height", rig.left.size.height},
          {"left_focal_px", rig.left.fx_px},
          {"right_focal_px", rig.right.fx_px},
          {"baseline_m", rig.baseline_m()},
          {"metric", rig.metric},
          {"turns_deg", list(turns_deg(rig.right_from_left.rotation))}};
}

std::string text_of(const SceneHealth& h) {
  std::string text = fmt::format("points   {} in {} pair{}, in {:.0f} % of the picture{}\n", h.points, h.pairs,
                                 h.pairs == 1 ? "" : "s", 100 * h.covered, h.missing.empty() ? "" : "; none in " + h.missing);
  text += fmt::format(
      "rows     {:.2f} px off (good below {}, useless from {}); single points {:.2f} px in the median, 95 % within {:.2f}\n",
      h.row_px, kGoodRow_px, kUselessRow_px, h.row_median_px, h.row_p95_px);
  const Vec3 turned = kDeg * h.turned_rad, sigma = kDeg * h.turned_sigma_rad;
  text += fmt::format(
      "pose     the scene has the right camera turned from the rig's by tilt {:.3f} +- {:.3f}, pan {:.3f} +- {:.3f}, roll "
      "{:.3f} +- "
      "{:.3f} degrees; that pan shifts disparities by {:.1f} +- {:.1f} px\n",
      turned.x, sigma.x, turned.y, sigma.y, turned.z, sigma.z, h.pan_px, h.pan_sigma_px);
  return text;
}

nlohmann::json report_json(const SceneHealth& h) {
  return {{"verdict", name_of(h.verdict)},
          {"pairs", h.pairs},
          {"points", h.points},
          {"covered", h.covered},
          {"missing", h.missing},
          {"row_px", h.row_px},
          {"row_median_px", h.row_median_px},
          {"row_p95_px", h.row_p95_px},
          {"turned_deg", list(kDeg * h.turned_rad)},
          {"turned_sigma_deg", list(kDeg * h.turned_sigma_rad)},
          {"pan_px", h.pan_px},
          {"pan_sigma_px", h.pan_sigma_px}};
}

nlohmann::json report_json(const std::optional<RigFit>& fit) {
  if (!fit) return nullptr;
  return {{"verdict", name_of(fit->verdict)},
          {"what", fit->what},
          {"disparity_sigma_px", fit->disparity_sigma_px},
          {"scene", fit->scene ? report_json(*fit->scene) : nlohmann::json()}};
}

std::string json_of(const Rig& rig) { return json_text(report_json(rig)); }
std::string json_of(const SceneHealth& health) { return json_text(report_json(health)); }
std::string json_of(const std::optional<RigFit>& fit) { return json_text(report_json(fit)); }

}  // namespace duo
