// The report of a calibration: one HTML file that needs nothing else.
#include <fmt/format.h>

#include <numbers>

#include "calib/report_plots.h"
#include "core/file.h"

namespace duo {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

constexpr char kStyle[] = R"(<style>
body{font:16px/1.5 system-ui,-apple-system,"Segoe UI",Helvetica,Arial,sans-serif;color:#1f2933;background:#eef1f4;margin:0}
main{max-width:1040px;margin:0 auto;padding:28px 20px 60px}
h1{font-size:28px;margin:0}h2{font-size:19px;margin:0 0 4px}p{margin:4px 0 12px;color:#52606d}
section{background:#fff;border-radius:10px;padding:20px 24px;margin-top:18px;box-shadow:0 1px 3px #0002}
.tiles{display:grid;grid-template-columns:repeat(4,1fr);gap:14px;margin-top:18px}
.tile{background:#fff;border-radius:10px;padding:14px 18px;box-shadow:0 1px 3px #0002}
.tile b{display:block;font-size:25px;font-weight:600}.tile span{color:#52606d;font-size:14px}
.badge{display:inline-block;border-radius:16px;padding:3px 14px;margin-left:14px;font-size:16px;vertical-align:5px;color:#fff}
.good{background:#2e7d32}.doubt{background:#c77700}
.two{display:grid;grid-template-columns:1fr 1fr;gap:18px}.two figure{margin:0}figcaption{font-size:14px;color:#52606d}
svg{width:100%;height:auto;display:block;border-radius:4px}.ground{fill:#f7f9fb}
table{border-collapse:collapse;width:100%}td,th{padding:4px 10px;border-bottom:1px solid #e4e7eb;text-align:right;font-weight:400}
th{color:#52606d;font-size:14px}td:first-child,th:first-child{text-align:left}td{font-variant-numeric:tabular-nums}
li{margin:4px 0}code{background:#f0f3f6;padding:2px 6px;border-radius:4px}
@media(max-width:760px){.tiles,.two{grid-template-columns:1fr 1fr}.two{grid-template-columns:1fr}}
@media print{body{background:#fff}section,.tile{box-shadow:none;border:1px solid #ddd;break-inside:avoid}}
</style>)";

std::string tile(const std::string& value, const char* what) {
  return fmt::format("<div class=\"tile\"><b>{}</b><span>{}</span></div>", value, what);
}

std::string row(const char* what, const std::string& first, const std::string& second) {
  return fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td></tr>", what, first, second);
}

std::string head(const Calibration& c, const Board& board) {
  int used = 0;
  for (const BoardView& view : c.views) used += view.used;
  const bool good = c.warnings.empty();
  std::string out = fmt::format("<h1>Calibration report<span class=\"badge {}\">{}</span></h1>", good ? "good" : "doubt",
                                good ? "good" : "usable, with doubts");
  out += fmt::format("<p>{} &amp; {}, {}x{}; {}, squares of {:.5g} mm; {} of {} views used; {}</p>", html_of(c.rig.left_name),
                     html_of(c.rig.right_name), c.rig.left.size.width, c.rig.left.size.height, board.name(),
                     1000 * board.square_m, used, c.views.size(), html_of(c.rig.date));
  if (!good) {
    out += "<section><h2>What to know before trusting it</h2><ul>";
    for (const std::string& warning : c.warnings) out += fmt::format("<li>{}</li>", html_of(warning));
    out += "</ul></section>";
  }
  out += "<div class=\"tiles\">";
  out += tile(fmt::format("{:.3f} px", c.rig.reprojection_rms_px), "corners lie off their predicted place (rms)");
  out += tile(fmt::format("{:.3f} px", c.rig.errors.held_out_row_px), "rows differ on views left out (rms)");
  out += tile(fmt::format("{:.1f} mm", 1000 * c.held_out_shape_m),
              fmt::format("off on boards {:.2f} m away (rms)", c.held_out_z_m).c_str());
  return out + tile(fmt::format("&plusmn; {:.1f} mm", 1000 * c.rig.uncertainty->depth_m[1]), "depth at 1.5 m (one sigma)") +
         "</div>";
}

std::string tables(const Calibration& c, const RigDescription& can) {
  const Rig& rig = c.rig;
  const RigUncertainty& u = *rig.uncertainty;
  const auto lens = [](const Camera& camera) {
    const auto& k = camera.distortion;
    return fmt::format("{:.4f}, {:.4f}, {:.4f}, {:.4f}, {:.4f}", k[0], k[1], k[2], k[3], k[4]);
  };
  const auto focal = [](const Camera& camera, double sigma_px) {
    return fmt::format("{:.2f}, {:.2f} &plusmn; {:.2f} px", camera.fx_px, camera.fy_px, sigma_px);
  };
  const auto centre = [](const Camera& camera) { return fmt::format("{:.1f}, {:.1f} px", camera.cx_px, camera.cy_px); };
  std::string out = "<section><h2>Cameras</h2><table><tr><th></th><th>left</th><th>right</th></tr>";
  out += row("focal length x, y", focal(rig.left, u.left_focal_px), focal(rig.right, u.right_focal_px));
  out += row("centre", centre(rig.left), centre(rig.right));
  out += row("distortion k1 k2 p1 p2 k3", lens(rig.left), lens(rig.right));
  out +=
      row("corners off by (rms)", fmt::format("{:.3f} px", rig.errors.left_px), fmt::format("{:.3f} px", rig.errors.right_px));
  out += "</table></section><section><h2>Pose and errors</h2><table><tr><th></th><th>value</th><th>one sigma</th></tr>";
  const Mat3& r = rig.right_from_left.rotation;
  const auto angle = [&](const char* what, double twice_sine, double sigma_rad) {
    out += row(what, fmt::format("{:.3f}&deg;", twice_sine / 2 * kDegrees), fmt::format("{:.3f}&deg;", sigma_rad * kDegrees));
  };
  out += row("baseline", fmt::format("{:.2f} mm", 1000 * rig.baseline_m()), fmt::format("{:.2f} mm", 1000 * u.baseline_m));
  angle("right camera's tilt", r(2, 1) - r(1, 2), u.tilt_rad);
  angle("right camera's pan", r(0, 2) - r(2, 0), u.pan_rad);
  angle("right camera's roll", r(1, 0) - r(0, 1), u.roll_rad);
  for (std::size_t i = 0; i < kJudgedDepths_m.size(); ++i)
    out += row(fmt::format("depth at {} m", kJudgedDepths_m[i]).c_str(), "", fmt::format("{:.1f} mm", 1000 * u.depth_m[i]));
  out += "</table><table><tr><th></th><th>views used</th><th>views left out</th></tr>";
  out += row("corners off by (rms)", fmt::format("{:.3f} px", rig.reprojection_rms_px),
             fmt::format("{:.3f} px", rig.errors.held_out_px));
  out += row("rows off by (rms)", fmt::format("{:.3f} px", rig.errors.row_px),
             fmt::format("{:.3f} px", rig.errors.held_out_row_px));
  out += fmt::format(
      "</table><p>Sigma is what noise of the corners does, and it takes the squares for exactly as large as said: a "
      "print that is 1&nbsp;% too large makes every distance 1&nbsp;% too short.</p></section><section><h2>What it can do</h2>"
      "<p>Both cameras see {:.0f}&deg;, {:.0f}&nbsp;% of the left picture at 2 m. Depth from {:.4g} m on needs "
      "<code>--max-disparity {}</code>. A quarter pixel of disparity is {:.1f} mm at 1 m, {:.1f} mm at 2 m, {:.1f} mm "
      "at 3 m.</p></section>",
      can.common_degrees, 100 * can.common_share, can.near_m, can.max_disparity, 1000 * can.step_m[0], 1000 * can.step_m[1],
      1000 * can.step_m[2]);
  return out;
}

std::string pair_of_plots(const char* title, const char* how_to_read, const Calibration& c,
                          std::string (*plot)(const Calibration&, int)) {
  return fmt::format(
      "<section><h2>{}</h2><p>{}</p><div class=\"two\"><figure>{}<figcaption>left</figcaption></figure><figure>{}"
      "<figcaption>right</figcaption></figure></div></section>",
      title, how_to_read, plot(c, 0), plot(c, 1));
}

}  // namespace

Result<void> write_calibration_report(const Calibration& calibration, const Board& board, const RigDescription& can,
                                      const Pair& shown, const std::filesystem::path& path) {
  DUO_TRY_ASSIGN(const std::string rows, rows_svg(calibration.rig, shown));
  std::string page =
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Calibration report</title>"
      "<meta name=\"viewport\" content=\"width=device-width\">";
  page += kStyle;
  page += "<main>" + head(calibration, board);
  page +=
      "<section><h2>A rectified pair</h2><p>What lies on a line in the left picture must lie on the same line in the right "
      "one: "
      "look at corners of the board and of furniture.</p>" +
      rows + "</section>";
  page += pair_of_plots("Where the board was",
                        "A colour a view. In red cells there was no corner: the lens is extrapolated there. Grey and "
                        "broken: not used.",
                        calibration, coverage_svg);
  page += pair_of_plots("What is left over",
                        "From where a corner should be to where it was seen, enlarged. Good: short, in all directions. "
                        "Whole regions that point the same way: bent board, or corners missing there.",
                        calibration, residuals_svg);
  page += pair_of_plots("The same around one point",
                        "Good: round and dense. A stripe: motion, or left and right not taken at the same time.", calibration,
                        scatter_svg);
  page +=
      "<section><h2>View by view</h2><p>Corners off by, px rms; dark left, light right; in order of the pictures. One far "
      "above the "
      "others: the board moved or was bent there.</p>" +
      views_svg(calibration) + "</section>";
  page += tables(calibration, can) + "</main></html>\n";
  return write_file(path, page);
}

}  // namespace duo
