// duoptic depth: pictures or videos in, disparity, depth and points out.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "command.h"
#include "duoptic/calibrate.h"
#include "duoptic/pipeline.h"
#include "frame_files.h"
#include "input.h"
#include "interrupt.h"
#include "progress.h"
#include "timing.h"

namespace duo::app::depth {
namespace {

namespace fs = std::filesystem;

constexpr char kFooter[] =
    "Writes into DIR: disparity.pfm (float px, +inf where unknown) and disparity.png (colours with a legend); with --rig also\n"
    "depth.png (16 bits, mm, 0 = unknown) and cloud.ply (coloured points, m). Videos give one folder for each frame:\n"
    "DIR/frame_000000/disparity.pfm, ... The files of a frame appear together or not at all.\n\n"
    "Examples:\n"
    "  duoptic depth left.png right.png --max-disparity 64 -o out          a rectified pair\n"
    "  duoptic depth left.avi right.avi --rig rig.json --every 10 -o out   raw webcam videos, every tenth frame\n"
    "  duoptic depth left.avi right.avi --rig rig.json --near 0.5 -o out   everything farther than half a metre\n"
    "  duoptic depth both.png --preset thesis                              both views side by side in one file\n"
    "  duoptic depth left.png right.png --window 200,120,160,160 -o out    only there, the same values, sooner";

struct Options {
  std::string left, right, rig, folder = "duoptic_out";
  int max_disparity = Setup().max_disparity;
  InputOptions input;
  double near_m = 0;  // 0: max_disparity says how far to search
  std::int64_t every = 1;
  std::vector<std::string> windows;
  bool confidence = false, keep_rows = false, json = false, quiet = false;
  EngineOptions engine;
};

/// "X,Y,W,H" as columns [X, X + W) of rows [Y, Y + H).
Window parse_window(const std::string& text) {
  int values[4] = {}, n = 0;
  const char *at = text.data(), *const end = at + text.size();
  for (; n < 4; ++n) {
    const auto [rest, error] = std::from_chars(at, end, values[n]);
    if (error != std::errc() || (rest != end && *rest != ',') || (rest == end) != (n == 3)) break;
    at = rest + (rest != end);
  }
  const Window window{values[0], values[1], values[2], values[3]};
  if (n < 4 || window.empty() || values[0] < 0 || values[1] < 0 ||
      std::max({values[0], values[1], values[2], values[3]}) > 1 << 20)
    throw CLI::ValidationError("--window", fmt::format("'{}' is not X,Y,W,H with a corner >= 0 and a size >= 1 px", text));
  return window;
}

/// Each window has to have a part in the picture, or who asked is mistaken.
Result<void> look_at(Pipeline& pipeline, const Options& options) {
  const Size size = pipeline.rectified() ? pipeline.rectified()->size : pipeline.setup().size;
  std::vector<Window> windows;
  for (const std::string& text : options.windows) {
    windows.push_back(parse_window(text));
    if (windows.back().within(size).empty())
      return Error{ErrorCode::kBadInput,
                   fmt::format("look at --window {}: it lies outside the rectified left picture, which is {}x{}", text,
                               size.width, size.height)};
  }
  pipeline.look_at(windows);
  return {};
}

struct Summary {
  std::vector<double> ms;
  std::vector<std::string> files;
  double coverage_sum = 0;
  Next end = Next::kEnd;
};

Result<Summary> process(Pipeline& pipeline, const Options& options, const CLI::App& app) {
  Summary summary;
  Progress progress(app, pipeline.count(), options.quiet);
  std::optional<Interrupt> interrupt;
  if (pipeline.live()) interrupt.emplace();
  while (!Interrupt::asked()) {
    DUO_TRY_ASSIGN(summary.end, pipeline.next());
    if (summary.end == Next::kNothing) continue;
    if (summary.end != Next::kNew) break;
    if (const std::string event = pipeline.event(); !event.empty()) say(app, "warning: " + event);
    summary.ms.push_back(pipeline.times().engine_ms);
    summary.coverage_sum += coverage(*pipeline.frame());

    const std::uint64_t number = pipeline.pair()->sequence;
    const fs::path folder =
        pipeline.still() ? fs::path(options.folder) : fs::path(options.folder) / fmt::format("frame_{:06}", number);
    DUO_TRY_ASSIGN(OutputSet out, OutputSet::open(folder));
    DUO_TRY(write_frame(*pipeline.frame(), pipeline.rectified(), out));
    DUO_TRY(out.publish());
    for (std::string& path : out.paths()) summary.files.push_back(std::move(path));
    progress.frame(static_cast<std::int64_t>(number) + 1);
  }
  return summary;
}

nlohmann::json json_of(const std::optional<RowOffsets>& rows) {
  if (!rows) return nullptr;
  return {{"points", rows->points},
          {"least_px", rows->least_px},
          {"most_px", rows->most_px},
          {"median_before_px", rows->before_px},
          {"median_after_px", rows->after_px},
          {"columns_px", rows->lens ? rows->lens->columns_px : 0.0}};
}

void print(const Summary& summary, const Pipeline& pipeline, const Options& options) {
  const Setup& setup = pipeline.setup();
  const double frames = static_cast<double>(summary.ms.size()), ms = median(summary.ms);
  const double percent = frames > 0 ? 100 * summary.coverage_sum / frames : 0;
  if (options.json) {
    const nlohmann::json out = {{"frames", summary.ms.size()},
                                {"pairs_read", pipeline.read()},
                                {"width", setup.size.width},
                                {"height", setup.size.height},
                                {"engine", pipeline.header().engine},
                                {"device", pipeline.header().device},
                                {"threads", options.engine.threads},
                                {"matcher", options.engine.matcher},
                                {"preset", options.engine.preset},
                                {"max_disparity_px", setup.max_disparity},
                                {"median_ms", ms},
                                {"coverage_percent", percent},
                                {"rows", json_of(setup.rows)},
                                {"cut", summary.end == Next::kCut},
                                {"warning", pipeline.warning()},
                                {"files", summary.files}};
    fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else if (!options.quiet) {
    if (setup.rows)
      fmt::print(
          "rows disagreed by {:.1f} px at the median ({:.1f} to {:.1f}), by {} points: put right to {:.2f} px; --keep-rows "
          "leaves them\n",
          setup.rows->before_px, setup.rows->least_px, setup.rows->most_px, setup.rows->points, setup.rows->after_px);
    if (setup.rows && setup.rows->lens)
      fmt::print(
          "the rows tell that the right picture was undistorted or scaled wrongly: columns, off by {:.1f} px near its sides, "
          "too\n",
          setup.rows->lens->columns_px);
    fmt::print(
        "{} frame{} of {}x{}, {:.1f} ms each ({}, {}, {} threads), {:.0f} % of the pixels have a disparity; written to {}\n",
        summary.ms.size(), summary.ms.size() == 1 ? "" : "s", setup.size.width, setup.size.height, ms, pipeline.header().engine,
        options.engine.preset, options.engine.threads, percent, options.folder);
  }
}

/// Of pairs that no rig rectifies: what their rows are off, where it matters. A live source cannot be read twice.
Result<std::optional<RowOffsets>> rows_of(const Options& options, const Setup& setup, bool live) {
  if (setup.rig || options.keep_rows || live) return std::optional<RowOffsets>();
  DUO_TRY_ASSIGN(const Input again, open_input(options.left, options.right, {}, options.input));
  DUO_TRY_ASSIGN(const RowOffsets rows, find_row_offsets(*again.pairs, options.engine.threads));
  return rows.matter() ? std::optional(rows) : std::nullopt;
}

Result<Exit> run(const Options& options, const CLI::App& app) {
  PipelineSetup setup{.engine = options.engine.engine, .threads = options.engine.threads, .every = options.every};
  Setup& frames = setup.frames = options.engine.setup();
  if (!options.rig.empty()) {
    DUO_TRY_ASSIGN(frames.rig, load_rig(options.rig));
  }
  DUO_TRY_ASSIGN(Input input, open_input(options.left, options.right, frames.rig, options.input));
  frames.rig = input.rig;
  if (options.near_m > 0 && !frames.rig) throw CLI::RequiredError("--rig");
  frames.max_disparity = options.max_disparity;
  if (frames.rig) {
    if (options.near_m > 0) {
      DUO_TRY_ASSIGN(frames.max_disparity, disparities_from(*frames.rig, options.near_m));
    }
    frames.wants = {.color = true, .depth = true};
  }
  frames.wants.confidence = options.confidence;
  DUO_TRY_ASSIGN(frames.rows, rows_of(options, frames, input.pairs->live()));
  DUO_TRY_ASSIGN(Pipeline pipeline, Pipeline::open(std::move(input.pairs), std::move(setup)));
  DUO_TRY(look_at(pipeline, options));
  DUO_TRY_ASSIGN(const Summary summary, process(pipeline, options, app));
  print(summary, pipeline, options);
  if (const std::string warning = pipeline.warning(); !warning.empty()) say(app, "warning: " + warning);
  return summary.end == Next::kCut ? Exit::kCut : Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("depth", "Disparity, depth and points of pictures or videos");
  const auto options = std::make_shared<Options>();
  sub->add_option("LEFT", options->left, "Picture or video of the left camera, a recording, or one file with both views")
      ->required();
  sub->add_option("RIGHT", options->right, "Picture or video of the right camera");
  sub->add_option(
      "--rig", options->rig,
      "Calibration (our JSON, OpenCV's YAML or JSON); without it, and in no recording that has one, the pair is taken "
      "as rectified");
  options->input.add_to(*sub);
  CLI::Option* most = sub->add_option("--max-disparity", options->max_disparity, "Searches 0 .. N-1 px")
                          ->type_name("N")
                          ->check(CLI::Range(1, Engine::kMaxDisparity))
                          ->capture_default_str();
  sub->add_option("--near", options->near_m, "Searches as far as something at this distance needs, by the rig")
      ->type_name("METRES")
      ->check(CLI::PositiveNumber)
      ->excludes(most);
  sub->add_option("-o,--output", options->folder, "Folder for the results")->type_name("DIR")->capture_default_str();
  sub->add_option("--every", options->every, "Of a video, only every N-th frame")
      ->type_name("N")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 40))
      ->capture_default_str();
  sub->add_option("--window", options->windows,
                  "Only these pixels of the rectified left picture matter, with the values they would have without it; may be "
                  "repeated")
      ->type_name("X,Y,W,H")
      ->check(CLI::Validator(
          [](std::string& text) {
            parse_window(text);
            return std::string();
          },
          ""));
  options->engine.add_to(*sub);
  sub->add_flag("--confidence", options->confidence,
                "Write confidence.png, too: 1 doubtful .. 255 sure, 0 = unknown (matcher sgm)");
  sub->add_flag("--keep-rows", options->keep_rows, "Do not correct the rows of a pair without a rig");
  sub->add_flag("--json", options->json, "Print the summary as JSON");
  sub->add_flag("--quiet", options->quiet, "Print nothing but errors and warnings");
  sub->footer(kFooter);
  return {sub, [options, sub] { return run(*options, *sub); }};
}

}  // namespace duo::app::depth
