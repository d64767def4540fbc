// duoptic calibrate: pictures of a board in, a rig out that says how good it is.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "command.h"
#include "duoptic/interrupt.h"
#include "duoptic/reports.h"
#include "duoptic/stdout.h"
#include "input.h"
#include "progress.h"

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
  std::string board = "chessboard:9x6", output, report, left_name = "left", right_name = "right";
  std::optional<double> square_mm;
  double near_m = 0.5;
  bool json = false, quiet = false, no_board = false;
  InputOptions input;
  std::string intrinsics;            // of --from-scene: a rig file whose cameras are used; empty: unknown lenses, not metric
  std::optional<double> baseline_m;  // likewise; none: that of the intrinsics' rig
};

/// rig.json gets rig_report.html, a rig on stdout none.
std::filesystem::path report_path(const Options& options) {
  if (!options.report.empty()) return options.report;
  const std::filesystem::path rig = options.output;
  if (is_stdout(rig)) return {};
  return rig.parent_path() / (rig.stem().string() + "_report.html");
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

constexpr double kGuessedBaseline_m = 0.1;  // of a rig that is not metric

Result<std::optional<Rig>> read_lenses(const Options& options) {
  if (options.intrinsics.empty()) return std::optional<Rig>{};
  DUO_TRY_ASSIGN(Rig rig, load_rig(options.intrinsics));
  if (!rig.metric)
    return Error{ErrorCode::kBadInput,
                 fmt::format("the lenses of '{}' are a guess (it is not metric); give a rig of a board", options.intrinsics)};
  return std::optional<Rig>{std::move(rig)};
}

/// Writes the rig and prints what the scene says of it; one that the scene itself calls useless is not written.
Result<Exit> from_scene(const Options& options, const CLI::App& app) {
  const bool prints = may_print(options.output, options.json);
  DUO_TRY_ASSIGN(const std::optional<Rig> lenses, read_lenses(options));
  DUO_TRY_ASSIGN(const auto pairs, open_pairs(options.input.left, options.input.right, options.input.wish()));
  const double baseline_m = options.baseline_m ? *options.baseline_m : lenses ? lenses->baseline_m() : kGuessedBaseline_m;
  DUO_TRY_ASSIGN(SceneRig found, rig_from_scene(lenses, baseline_m, *pairs, 1));
  if (found.after.verdict == RigVerdict::kRecalibrate)
    return Error{
        ErrorCode::kBadInput,
        fmt::format("no rig fits this scene: its rows stay {:.2f} px off{}; show a scene with texture at several distances, "
                    "or calibrate with a board",
                    found.after.row_px, lenses ? ", so the intrinsics may belong to other cameras" : "")};
  if (Interrupt::asked()) return stopped("the rig was written");
  found.rig.date = date_now();
  DUO_TRY(save_rig(found.rig, options.output));
  if (options.json) {
    print_json({{"rig", nlohmann::json::parse(json_of(found.rig))},
                {"scene", nlohmann::json::parse(json_of(found.after))},
                {"file", options.output}});
  } else if (prints) {
    fmt::print("rig      {}\n{}verdict  {}; written to {}\n", text_of(found.rig), text_of(found.after),
               name_of(found.after.verdict), options.output);
  }
  if (!found.rig.metric)
    say(app, "warning: without --intrinsics the rig is not metric: rows agree and nearer is nearer, but distances are a guess");
  if (!found.after.missing.empty()) say(app, "warning: no points in " + found.after.missing + "; move the rig and try again");
  if (!pairs->warning().empty()) say(app, "warning: " + pairs->warning());
  return found.after.cut ? Exit::kCut : Exit::kOk;
}

Result<Exit> run(Options options, const CLI::App& app) {
  const bool prints = may_print(options.output, options.json) && !options.quiet;
  DUO_TRY_ASSIGN(const Paper paper, parse_paper("a4"));
  DUO_TRY_ASSIGN(const Board board, options.square_mm ? parse_board(options.board, *options.square_mm / 1000)
                                                      : largest_board(options.board, paper));
  const bool assumed = !options.square_mm;
  options.square_mm = 1000 * board.square_m;
  DUO_TRY_ASSIGN(BoardPictures pictures, BoardPictures::open(options.input.left, options.input.right, options.input.wish()));
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
  if (!calibrator) return Error{ErrorCode::kBadInput, fmt::format("cannot calibrate: {} has no pictures", options.input.left)};
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
  const CalibrationReport all{calibration, *calibrator, description, options.output, report.string(), *options.square_mm};
  if (options.json)
    fmt::print("{}\n", json_of(all));
  else if (prints)
    fmt::print("{}", text_of(all));
  for (const std::string& warning : calibration.warnings) say(app, "warning: " + warning);
  if (!pictures.warning().empty()) say(app, "warning: " + pictures.warning());
  return pictures.cut() ? Exit::kCut : Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("calibrate", "A rig from pictures of a board, or of any scene");
  const auto options = std::make_shared<Options>();
  sub->add_option("LEFT", options->input.left, "Video or folder of pictures of the left camera")->required();
  sub->add_option("RIGHT", options->input.right, "The same of the right camera");
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
  options->input.add_to(*sub);
  sub->add_option("--intrinsics", options->intrinsics,
                  "With --from-scene: a rig file of the same cameras, of which only the lenses are used; without it the rig is "
                  "not metric")
      ->type_name("RIG");
  sub->add_option("--baseline-m", options->baseline_m, "With --from-scene: from lens to lens; without it that of --intrinsics")
      ->type_name("M")
      ->check(within(0.01, 5.0));
  sub->add_flag("--json", options->json, "Print the result as JSON");
  sub->add_flag("--quiet", options->quiet, "Print nothing but errors and warnings");
  sub->footer(kFooter);
  return {sub, [options, sub] { return options->no_board ? from_scene(*options, *sub) : run(*options, *sub); }};
}

}  // namespace duo::app::calibrate
