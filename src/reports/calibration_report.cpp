#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <numbers>

#include "duoptic/reports.h"
#include "reports/report_json.h"

namespace duo {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

/// A line a reason, with the first few views that it left out.
std::string text_of_unused(const std::vector<BoardView>& views) {
  std::string text;
  constexpr std::size_t kNamed = 4;
  std::map<std::string, std::vector<std::string>> names;
  for (const BoardView& view : views)
    if (!view.used && view.why_not != "no board found" && view.why_not != "much like another")
      names[view.why_not.substr(0, view.why_not.find(':'))].push_back(view.name);
  for (auto& [why, of] : names) {
    const std::size_t count = of.size();
    if (count > kNamed) of.resize(kNamed), of.push_back("...");
    text += fmt::format("  {} not used: {} ({})\n", count, why, fmt::join(of, "; "));
  }
  return text;
}

}  // namespace

std::string json_of(const CalibrationReport& report) {
  const Calibration& c = report.calibration;
  const Calibrator& calibrator = report.calibrator;
  const RigDescription& description = report.description;
  const RigErrors& e = c.rig.errors;
  const RigUncertainty& u = *c.rig.uncertainty;
  nlohmann::json views = nlohmann::json::array();
  for (const BoardView& view : c.views)
    views.push_back({{"name", view.name},
                     {"used", view.used},
                     {"why_not", view.why_not},
                     {"left_corners", view.left.size()},
                     {"right_corners", view.right.size()},
                     {"edge_px", view.sharp_px}});
  return json_text({{"rig", report.rig_file},
                    {"report", report.report_file},
                    {"warnings", c.warnings},
                    {"pairs", calibrator.pairs()},
                    {"views", views},
                    {"coverage", {calibrator.coverage(0), calibrator.coverage(1)}},
                    {"reprojection_px", c.rig.reprojection_rms_px},
                    {"errors",
                     {{"left_px", e.left_px},
                      {"right_px", e.right_px},
                      {"row_px", e.row_px},
                      {"held_out_px", e.held_out_px},
                      {"held_out_row_px", e.held_out_row_px},
                      {"held_out_shape_mm", 1000 * c.held_out_shape_m},
                      {"held_out_shape_at_m", c.held_out_z_m}}},
                    {"uncertainty",
                     {{"left_focal_px", u.left_focal_px},
                      {"right_focal_px", u.right_focal_px},
                      {"tilt_deg", u.tilt_rad * kDegrees},
                      {"pan_deg", u.pan_rad * kDegrees},
                      {"roll_deg", u.roll_rad * kDegrees},
                      {"baseline_mm", 1000 * u.baseline_m},
                      {"depth_at_m", kJudgedDepths_m},
                      {"depth_mm", {1000 * u.depth_m[0], 1000 * u.depth_m[1], 1000 * u.depth_m[2]}}}},
                    {"baseline_m", c.rig.baseline_m()},
                    {"common_degrees", description.common_degrees},
                    {"common_share", description.common_share},
                    {"near_m", description.near_m},
                    {"max_disparity", description.max_disparity},
                    {"depth_step_at_1_2_3_m", description.step_m}});
}

std::string text_of(const CalibrationReport& report) {
  const Calibration& c = report.calibration;
  const Calibrator& calibrator = report.calibrator;
  const RigDescription& description = report.description;
  const Rig& rig = c.rig;
  const RigErrors& e = rig.errors;
  const RigUncertainty& u = *rig.uncertainty;
  const auto used = std::count_if(c.views.begin(), c.views.end(), [](const BoardView& v) { return v.used; });
  std::string text = fmt::format("{} of {} pairs used; corners cover {:.0f} % of the left picture and {:.0f} % of the right\n",
                                 used, calibrator.pairs(), 100 * calibrator.coverage(0), 100 * calibrator.coverage(1));
  text += text_of_unused(c.views);
  text += fmt::format("error of the corners    {:.3f} px (left {:.3f}, right {:.3f}); of rows {:.3f} px\n",
                      rig.reprojection_rms_px, e.left_px, e.right_px, e.row_px);
  text += fmt::format("on views left out       {:.3f} px, rows {:.3f} px; boards {:.2f} m away measured to {:.1f} mm\n",
                      e.held_out_px, e.held_out_row_px, c.held_out_z_m, 1000 * c.held_out_shape_m);
  text += fmt::format("focal length            {:.1f} +- {:.1f} px and {:.1f} +- {:.1f} px\n",
                      (rig.left.fx_px + rig.left.fy_px) / 2, u.left_focal_px, (rig.right.fx_px + rig.right.fy_px) / 2,
                      u.right_focal_px);
  text += fmt::format("baseline                {:.2f} +- {:.2f} mm; pan +- {:.3f}, tilt +- {:.3f}, roll +- {:.3f} degrees\n",
                      1000 * rig.baseline_m(), 1000 * u.baseline_m, u.pan_rad * kDegrees, u.tilt_rad * kDegrees,
                      u.roll_rad * kDegrees);
  text += fmt::format(
      "depth expected to be    +- {:.1f} mm at 1 m, {:.1f} mm at 1.5 m, {:.1f} mm at 2 m (one sigma; squares of exactly {:g} "
      "mm)\n",
      1000 * u.depth_m[0], 1000 * u.depth_m[1], 1000 * u.depth_m[2], report.square_mm);
  text += fmt::format("both cameras see        {:.0f} degrees, {:.0f} % of the left picture at 2 m\n",
                      description.common_degrees, 100 * description.common_share);
  text += fmt::format("for depth from {} m     --max-disparity {}\n", description.near_m, description.max_disparity);
  text += fmt::format("a quarter pixel is      {:.1f} mm at 1 m, {:.1f} mm at 2 m, {:.1f} mm at 3 m\n",
                      1000 * description.step_m[0], 1000 * description.step_m[1], 1000 * description.step_m[2]);
  text += fmt::format("written to              {}; report with plots: {}\n", report.rig_file, report.report_file);
  return text;
}

}  // namespace duo
