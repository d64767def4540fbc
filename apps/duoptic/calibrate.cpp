// duoptic calibrate: pictures of a board in, a rig out that says how good it is.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "command.h"
#include "duoptic/calibrate.h"
#include "duoptic/interrupt.h"
#include "duoptic/stdout.h"
#include "from_scene.h"
#include "progress.h"
#include "rig_report.h"

namespace duo::app::calibrate {
namespace {

constexpr char kFooter[] =
    "LEFT and RIGHT are two videos, or two folders of pictures (or one, with left and right in their names) that pair by "
    "their\n"
    "numbers. Print a board (duoptic board), glue it to something flat, measure a square, and show it whole to both\n"
    "cameras 15 times or more: near and far, in all corners, tilted 20 to 40 degrees every way, still each time.\n\n"
    "Examples:\n"
    "  duoptic calibrate left.avi right.avi --board chessboard:9x6 --square-mm 30 -o rig.json\n"
    "  duoptic calibrate shots/left shots/right --board charuco:9x6 --square-mm 30 -o rig.json";

struct Options {
  std::string left, right, board = "chessboard:9x6", output, report, left_name = "left", right_name = "right";
  std::optional<double> square_mm;
  double near_m = 0.5;
  bool json = false, quiet = false, no_board = false;
  FromSceneOptions from_scene;
};

constexpr double kDegrees = 180 / std::numbers::pi;

/// rig.json gets rig_report.html, a rig on stdout none.
std::filesystem::path report_path(const Options& options) {
  if (!options.report.empty()) return options.report;
  const std::filesystem::path rig = options.output;
  if (is_stdout(rig)) return {};
  return rig.parent_path() / (rig.stem().string() + "_report.html");
}

nlohmann::json to_json(const Calibration& c, const Calibrator& calibrator, const RigDescription& description,
                       const Options& options) {
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
  return {{"rig", options.output},
          {"report", report_path(options).string()},
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
          {"depth_step_at_1_2_3_m", description.step_m}};
}

/// A line a reason, with the first few views that it left out.
void print_unused(const std::vector<BoardView>& views) {
  constexpr std::size_t kNamed = 4;
  std::map<std::string, std::vector<std::string>> names;
  for (const BoardView& view : views)
    if (!view.used && view.why_not != "no board found" && view.why_not != "much like another")
      names[view.why_not.substr(0, view.why_not.find(':'))].push_back(view.name);
  for (auto& [why, of] : names) {
    const std::size_t count = of.size();
    if (count > kNamed) of.resize(kNamed), of.push_back("...");
    fmt::print("  {} not used: {} ({})\n", count, why, fmt::join(of, "; "));
  }
}

void print(const Calibration& c, const Calibrator& calibrator, const RigDescription& description, const Options& options) {
  const Rig& rig = c.rig;
  const RigErrors& e = rig.errors;
  const RigUncertainty& u = *rig.uncertainty;
  const auto used = std::count_if(c.views.begin(), c.views.end(), [](const BoardView& v) { return v.used; });
  fmt::print("{} of {} pairs used; corners cover {:.0f} % of the left picture and {:.0f} % of the right\n", used,
             calibrator.pairs(), 100 * calibrator.coverage(0), 100 * calibrator.coverage(1));
  print_unused(c.views);
  fmt::print("error of the corners    {:.3f} px (left {:.3f}, right {:.3f}); of rows {:.3f} px\n", rig.reprojection_rms_px,
             e.left_px, e.right_px, e.row_px);
  fmt::print("on views left out       {:.3f} px, rows {:.3f} px; boards {:.2f} m away measured to {:.1f} mm\n", e.held_out_px,
             e.held_out_row_px, c.held_out_z_m, 1000 * c.held_out_shape_m);
  fmt::print("focal length            {:.1f} +- {:.1f} px and {:.1f} +- {:.1f} px\n", (rig.left.fx_px + rig.left.fy_px) / 2,
             u.left_focal_px, (rig.right.fx_px + rig.right.fy_px) / 2, u.right_focal_px);
  fmt::print("baseline                {:.2f} +- {:.2f} mm; pan +- {:.3f}, tilt +- {:.3f}, roll +- {:.3f} degrees\n",
             1000 * rig.baseline_m(), 1000 * u.baseline_m, u.pan_rad * kDegrees, u.tilt_rad * kDegrees, u.roll_rad * kDegrees);
  fmt::print(
      "depth expected to be    +- {:.1f} mm at 1 m, {:.1f} mm at 1.5 m, {:.1f} mm at 2 m (one sigma; squares of exactly {:g} "
      "mm)\n",
      1000 * u.depth_m[0], 1000 * u.depth_m[1], 1000 * u.depth_m[2], *options.square_mm);
  fmt::print("both cameras see        {:.0f} degrees, {:.0f} % of the left picture at 2 m\n", description.common_degrees,
             100 * description.common_share);
  fmt::print("for depth from {} m     --max-disparity {}\n", description.near_m, description.max_disparity);
  fmt::print("a quarter pixel is      {:.1f} mm at 1 m, {:.1f} mm at 2 m, {:.1f} mm at 3 m\n", 1000 * description.step_m[0],
             1000 * description.step_m[1], 1000 * description.step_m[2]);
  fmt::print("written to              {}; report with plots: {}\n", options.output, report_path(options).string());
}

/// The pair that shows the most of the board of those that calibrate: near, so that a wrong rig would be seen.
class ShownPair {
 public:
  void offer(const Pair& pair, const BoardView& view) {
    if (!view.why_not.empty()) return;
    double left_px = 1e9, right_px = 0;
    for (const BoardCorner& c : view.left) left_px = std::min(left_px, c.x_px), right_px = std::max(right_px, c.x_px);
    if (right_px - left_px <= width_px_) return;
    width_px_ = right_px - left_px;
    pair_.left.pixels = pair.left.pixels.clone(), pair_.right.pixels = pair.right.pixels.clone();
  }
  const Pair& pair() const { return pair_; }

 private:
  Pair pair_;
  double width_px_ = 0;
};

Result<Exit> from_scene(const Options& options, const CLI::App& app) {
  FromSceneOptions all = options.from_scene;
  all.left = options.left;
  all.right = options.right;
  all.output = options.output;
  all.json = options.json;
  return run_from_scene(all, app);
}

Result<Exit> run(Options options, const CLI::App& app) {
  const bool prints = may_print(options.output, options.json) && !options.quiet;
  DUO_TRY_ASSIGN(const Paper paper, parse_paper("a4"));
  DUO_TRY_ASSIGN(const Board board, options.square_mm ? parse_board(options.board, *options.square_mm / 1000)
                                                      : largest_board(options.board, paper));
  const bool assumed = !options.square_mm;
  options.square_mm = 1000 * board.square_m;
  DUO_TRY_ASSIGN(BoardPictures pictures, BoardPictures::open(options.left, options.right, options.from_scene.input.wish()));
  std::unique_ptr<Calibrator> calibrator;
  Progress progress(app, pictures.count(), options.quiet);
  Pair pair;
  ShownPair shown;
  for (std::string name;;) {
    DUO_TRY_ASSIGN(const bool more, pictures.next(pair, name));
    if (!more) break;
    if (!calibrator) calibrator = std::make_unique<Calibrator>(board, pair.left.pixels.size());
    DUO_TRY_ASSIGN(const BoardView* view, calibrator->add(pair, name));
    shown.offer(pair, *view);
    progress.frame(calibrator->pairs());
    if (Interrupt::asked()) return stopped("the rig was found");
  }
  if (!calibrator) return Error{ErrorCode::kBadInput, fmt::format("cannot calibrate: {} has no pictures", options.left)};
  DUO_TRY_ASSIGN(Calibration calibration, calibrator->solve());
  calibration.rig.left_name = options.left_name;
  calibration.rig.right_name = options.right_name;
  calibration.rig.date = date_now();
  if (assumed)
    calibration.warnings.push_back(
        fmt::format("--square-mm was not given, and squares of {:g} mm were assumed, as duoptic board prints them on A4: "
                    "measure them, every distance depends on it",
                    *options.square_mm));
  DUO_TRY_ASSIGN(const RigDescription description, describe_rig(calibration.rig, options.near_m));
  DUO_TRY(save_rig(calibration.rig, options.output));
  const auto report = report_path(options);
  if (!report.empty()) DUO_TRY(write_calibration_report(calibration, board, description, shown.pair(), report));
  if (options.json)
    fmt::print(
        "{}\n",
        to_json(calibration, *calibrator, description, options).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  else if (prints)
    print(calibration, *calibrator, description, options);
  for (const std::string& warning : calibration.warnings) say(app, "warning: " + warning);
  if (!pictures.warning().empty()) say(app, "warning: " + pictures.warning());
  return pictures.cut() ? Exit::kCut : Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("calibrate", "A rig from pictures of a board, or of any scene");
  const auto options = std::make_shared<Options>();
  sub->add_option("LEFT", options->left, "Video or folder of pictures of the left camera")->required();
  sub->add_option("RIGHT", options->right, "The same of the right camera");
  sub->add_option("--board", options->board, "chessboard:9x6 (inner corners) or charuco:9x6 (squares)")->capture_default_str();
  sub->add_option("--square-mm", options->square_mm,
                  "Side of a square as you measure it on the print; without it what duoptic board prints on A4")
      ->check(within(1.0, 1000.0));
  sub->add_option("-o,--output", options->output, "The rig file")->type_name("FILE")->required();
  sub->add_option("--report", options->report, "The report (HTML); without it beside the rig, as RIG_report.html")
      ->type_name("FILE");
  sub->add_option("--near", options->near_m, "Nearest depth in metres to print the disparities for")
      ->check(within(0.05, 100.0))
      ->capture_default_str();
  sub->add_option("--left-name", options->left_name, "What the rig calls the left camera")->capture_default_str();
  sub->add_option("--right-name", options->right_name, "And the right one")->capture_default_str();
  sub->add_flag("--from-scene", options->no_board, "No board: the pose from points of any scene, in two pictures or videos")
      ->excludes("--board");
  options->from_scene.input.add_to(*sub);
  add_from_scene_options(*sub, options->from_scene);
  sub->add_flag("--json", options->json, "Print the result as JSON");
  sub->add_flag("--quiet", options->quiet, "Print nothing but errors and warnings");
  sub->footer(kFooter);
  return {sub, [options, sub] { return options->no_board ? from_scene(*options, *sub) : run(*options, *sub); }};
}

}  // namespace duo::app::calibrate
