#include "calib/doubt_calibration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "duoptic/rig_health.h"

namespace duo {
namespace {

constexpr std::size_t kFewViews = 12;
constexpr double kUncertainDepth = 0.015;  // of the distance

/// Ninths of a picture in which no used view has a corner, in words.
std::vector<std::string> blank_ninths(const Calibration& calibration, bool left, Size size) {
  constexpr std::array<const char*, 9> kNames = {"upper left",   "upper middle", "upper right",  "middle left", "middle",
                                                 "middle right", "lower left",   "lower middle", "lower right"};
  std::array<bool, 9> seen{};
  for (const BoardView& view : calibration.views) {
    if (!view.used) continue;
    for (const BoardCorner& c : left ? view.left : view.right) {
      const int x = std::clamp(static_cast<int>(3 * c.x_px / size.width), 0, 2);
      const int y = std::clamp(static_cast<int>(3 * c.y_px / size.height), 0, 2);
      seen[static_cast<std::size_t>(3 * y + x)] = true;
    }
  }
  std::vector<std::string> out;
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (!seen[i]) out.emplace_back(kNames[i]);
  return out;
}

}  // namespace

std::vector<std::string> doubts_of(const Calibration& calibration) {
  const Rig& rig = calibration.rig;
  std::vector<std::string> out;
  for (const bool left : {true, false})
    if (const auto blank = blank_ninths(calibration, left, rig.left.size); !blank.empty())
      out.push_back(fmt::format("no corners in the {} of the {} picture: the lens is a guess there; show the board there, too",
                                fmt::join(blank, ", "), left ? "left" : "right"));
  std::size_t used = 0;
  std::vector<std::string> rejected;
  for (const BoardView& view : calibration.views) {
    used += view.used;
    if (view.rejected) rejected.push_back(view.name);
  }
  if (used < kFewViews) out.push_back(fmt::format("only {} views; 15 and more give a surer rig", used));
  if (!rejected.empty())
    out.push_back(fmt::format("{} of {} views do not fit the others and were left out ({}); hold the board still and flat",
                              rejected.size(), used + rejected.size(), fmt::join(rejected, "; ")));
  const RigErrors& e = rig.errors;
  if (e.held_out_row_px > 1.5 * e.row_px && e.held_out_row_px > 0.25)
    out.push_back(fmt::format("rows differ by {:.2f} px on views left out and {:.2f} px on the others: take more views",
                              e.held_out_row_px, e.row_px));
  // What a picture's noise makes of a point at that distance.
  const double z_m = calibration.held_out_z_m;
  const double expected_m = z_m * z_m / (rig.left.fx_px * rig.baseline_m()) * rig.reprojection_rms_px;
  if (calibration.held_out_shape_m > 3 * expected_m)
    out.push_back(
        fmt::format("boards come out bent by {:.1f} mm where {:.1f} mm are expected: tape the print flat onto something "
                    "stiff and measure its squares",
                    1000 * calibration.held_out_shape_m, 1000 * expected_m));
  if (const double sigma_m = rig.uncertainty->depth_m[1]; sigma_m > kUncertainDepth * kJudgedDepths_m[1])
    out.push_back(
        fmt::format("depth is uncertain by {:.0f} mm at {} m; show the board farther away (up to that distance), larger, "
                    "and tilted more",
                    1000 * sigma_m, kJudgedDepths_m[1]));
  for (const RigDoubt& doubt : rig_doubts(rig)) out.push_back(doubt.what);
  return out;
}

}  // namespace duo
