// duoptic depth: pictures or videos in, disparity, depth and points out.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "command.h"
#include "duoptic/calibrate.h"
#include "duoptic/frame_files.h"
#include "duoptic/interrupt.h"
#include "duoptic/pipeline.h"
#include "duoptic/reports.h"
#include "duoptic/timing.h"
#include "input.h"
#include "progress.h"
#include "run_news.h"

namespace duo::app::depth {
namespace {

constexpr char kFooter[] =
    "Writes into DIR: disparity.pfm (float px, +inf where unknown) and disparity.png (colours with a legend); with --rig also\n"
    "depth.png (16 bits, mm, 0 = unknown), left_rectified.png (the picture that depth.png is of), camera.json (its size, K,\n"
    "baseline and Q) and cloud.ply (coloured points, m). Videos give one folder for each frame, DIR/frame_000000/...; with\n"
    "--outputs depth-video one file, DIR/depth.mkv (16 bits, FFV1), beside its camera.json. The files of a frame appear\n"
    "together or not at all, and take the place of all files of an earlier run.\n\n"
    "Examples:\n"
    "  duoptic depth left.png right.png --max-disparity 64 -o out          a rectified pair\n"
    "  duoptic depth left.avi right.avi --rig rig.json --every 10 -o out   raw webcam videos, every tenth frame\n"
    "  duoptic depth left.avi right.avi --rig rig.json --near 0.5 -o out   everything farther than half a metre\n"
    "  duoptic depth left.png right.png --rig rig.json --outputs cloud --far 5 --axes blender -o out\n"
    "  duoptic depth left.avi right.avi --rig rig.json --outputs depth-video -o out   depth of all frames in one file\n"
    "  duoptic depth left.avi right.avi --rig rig.json --frames 3000:6000 -o out      a part of a long video\n"
    "  duoptic depth both.png --preset thesis                              both views side by side in one file\n"
    "  duoptic depth left.png right.png --window 200,120,160,160 -o out    only there, the same values, sooner";

struct Options {
  std::string folder = "duoptic_out";
  int max_disparity = Setup().max_disparity;
  InputOptions input;
  double near_m = 0;  // 0: max_disparity says how far to search
  double far_m = kNoFarLimit_m;
  std::vector<std::string> outputs;  // empty: all that there are, without confidence and depth-video
  Axes axes = Axes::kOpencv;
  std::int64_t every = 1;
  std::string range;  // of frames; empty: all
  std::vector<Window> windows;
  RigCheck check = RigCheck::kTell;
  bool confidence = false, keep_rows = false, json = false, quiet = false;
  EngineOptions engine;
};

struct Range {
  static constexpr std::int64_t kMost = std::int64_t{1} << 40;
  std::int64_t begin = 0, end = kMost;
};

/// "A:B" as frames A .. B-1; A alone or B alone may be missing.
Range parse_range(const std::string& text) {
  Range range;
  const std::size_t colon = std::min(text.find(':'), text.size());
  const auto number = [&](std::size_t from, std::size_t to, std::int64_t& into) {
    const auto [rest, error] = std::from_chars(text.data() + from, text.data() + to, into);
    return from == to || (error == std::errc() && rest == text.data() + to);
  };
  const bool numbers = colon < text.size() && number(0, colon, range.begin) && number(colon + 1, text.size(), range.end);
  if (!numbers || range.begin < 0 || range.end <= range.begin || range.end > Range::kMost)
    throw CLI::ValidationError("--frames", fmt::format("'{}' is not A:B with 0 <= A < B, like 0:3000, 3000: or :3000", text));
  return range;
}

/// Each window has to have a part in the picture, or who asked is mistaken.
Result<void> look_at(Pipeline& pipeline, const Options& options) {
  const Size size = pipeline.rectified() ? pipeline.rectified()->size : pipeline.setup().size;
  for (const Window& window : options.windows)
    if (window.within(size).empty())
      return Error{ErrorCode::kBadInput,
                   fmt::format("look at --window {},{},{},{}: it lies outside the rectified left picture, which is {}x{}",
                               window.x, window.y, window.width, window.height, size.width, size.height)};
  pipeline.look_at(options.windows);
  return {};
}

/// What is written of each frame; a video of all of them is not.
FrameFiles files_of(const Options& options) {
  FrameFiles files;
  if (!options.outputs.empty()) {
    files.outputs.clear();
    for (const std::string& name : options.outputs) {
      const auto found = std::find(kFrameOutputNames.begin(), kFrameOutputNames.end(), name);
      files.outputs.push_back(static_cast<FrameOutput>(found - kFrameOutputNames.begin()));
    }
  }
  if (options.confidence) files.outputs.push_back(FrameOutput::kConfidence);
  files.cloud.axes = options.axes;
  files.cloud.far_m = options.far_m;
  return files;
}

/// Share of pixels with a disparity, 0 .. 1.
double coverage(const Frame& frame) {
  const Image<std::uint8_t>& origin = frame.disparity.origin;
  std::int64_t known = 0;
  for (int y = 0; y < origin.height(); ++y)
    for (int x = 0; x < origin.width(); ++x) known += origin.at(y, x) != static_cast<std::uint8_t>(Origin::kNone);
  return static_cast<double>(known) / (static_cast<double>(origin.width()) * origin.height());
}

struct Summary {
  std::vector<double> ms;
  std::vector<std::string> files;
  double coverage_sum = 0;
  std::string far_warning;
  Next end = Next::kEnd;
};

Result<Summary> process(Pipeline& pipeline, const Options& options, const CLI::App& app, Progress& progress) {
  Summary summary;
  FrameFiles files = files_of(options);
  files.cloud.metric = pipeline.header().metric;
  DUO_TRY_ASSIGN(FrameFolder out, FrameFolder::open(options.folder, std::move(files), !options.outputs.empty(),
                                                    pipeline.rectified(), pipeline.still(),
                                                    pipeline.header().frame_s * static_cast<double>(options.every)));
  const Range range = parse_range(options.range.empty() ? ":" : options.range);
  if (!options.range.empty() && (pipeline.live() || pipeline.still()))
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot use --frames with {}: it is for the frames of videos", options.input.left)};
  bool beyond = false;  // the range
  FarWatch within_far(options.far_m);
  progress.expect(pipeline.count());
  if (pipeline.live()) Interrupt::is_the_end();
  RunNews news(app);
  // A run that fails is worth what it has.
  const auto with_what_is_left = [&](Error error) {
    const bool refused = options.check == RigCheck::kStrict && pipeline.rig_fit() && !pipeline.rig_fit()->what.empty();
    if (!refused) static_cast<void>(out.finish());
    if (const std::size_t frames = summary.ms.size(); frames > 0 && !out.paths().empty())
      error.what += fmt::format("; the {} frame{} before {} in {}", frames, frames == 1 ? "" : "s", frames == 1 ? "is" : "are",
                                options.folder);
    return error;
  };
  while (!Interrupt::asked()) {
    const Result<Next> next = pipeline.next();
    if (!next) return with_what_is_left(next.error());
    summary.end = *next;
    news.see(pipeline);
    if (summary.end == Next::kNothing) continue;
    if (summary.end != Next::kNew) break;
    beyond = static_cast<std::int64_t>(pipeline.pair()->sequence) >= range.end;
    if (beyond) break;
    if (const std::string event = pipeline.event(); !event.empty()) say(app, "warning: " + event);
    const std::uint64_t number = pipeline.pair()->sequence;
    if (pipeline.rig_fit()) out.set_disparity_sigma_px(pipeline.rig_fit()->disparity_sigma_px);
    if (const auto written = out.write(pipeline.frame(), number, pipeline.tracked().t_s); !written)
      return with_what_is_left(written.error());
    summary.ms.push_back(pipeline.times().engine_ms);
    summary.coverage_sum += coverage(*pipeline.frame());
    within_far.see(pipeline.frame()->depth_mm);
    progress.frame(static_cast<std::int64_t>(number) + 1);
  }
  if (summary.ms.empty() && !options.range.empty() && !beyond && summary.end == Next::kEnd)
    return Error{ErrorCode::kBadInput, fmt::format("cannot give frames {}: {} gives {} pair{}, numbered from 0", options.range,
                                                   options.input.left, pipeline.read(), pipeline.read() == 1 ? "" : "s")};
  summary.far_warning = within_far.warning();
  DUO_TRY(out.finish());
  summary.files = out.paths();
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

std::string all_warnings(const Summary& summary, const Pipeline& pipeline) {
  const std::string of_run = pipeline.warning();
  return of_run + (of_run.empty() || summary.far_warning.empty() ? "" : "; ") + summary.far_warning;
}

void print(const Summary& summary, const Pipeline& pipeline, const Options& options) {
  const Setup& setup = pipeline.setup();
  const double frames = static_cast<double>(summary.ms.size()), ms = median_of(summary.ms);
  const double percent = frames > 0 ? 100 * summary.coverage_sum / frames : 0;
  if (options.json) {
    const double sigma_px = pipeline.rig_fit() ? pipeline.rig_fit()->disparity_sigma_px : 0;
    const auto camera = pipeline.rectified()
                            ? nlohmann::json::parse(camera_json(*pipeline.rectified(), pipeline.header().metric, sigma_px))
                            : nullptr;
    print_json({{"frames", summary.ms.size()},
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
                {"rig_fit", nlohmann::json::parse(json_of(pipeline.rig_fit()))},
                {"camera", camera},
                {"cut", summary.end == Next::kCut},
                {"warning", all_warnings(summary, pipeline)},
                {"files", summary.files}});
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
  DUO_TRY_ASSIGN(const Input again, options.input.open());
  DUO_TRY_ASSIGN(const RowOffsets rows, find_row_offsets(*again.pairs, options.engine.threads));
  return rows.matter() ? std::optional(rows) : std::nullopt;
}

Result<Exit> run(const Options& options, const CLI::App& app) {
  const std::int64_t begin = options.range.empty() ? 0 : parse_range(options.range).begin;
  PipelineSetup setup{.engine = options.engine.engine,
                      .threads = options.engine.threads,
                      .first = (begin + options.every - 1) / options.every * options.every,  // frames of a run of all
                      .every = options.every,
                      .check = options.check};
  Setup& frames = setup.frames = options.engine.setup();
  DUO_TRY_ASSIGN(Input input, options.input.open());
  frames.rig = input.rig;
  if (options.near_m > 0 && !frames.rig) throw CLI::RequiredError("--rig");
  frames.max_disparity = options.max_disparity;
  if (frames.rig) {
    if (options.near_m > 0) {
      DUO_TRY_ASSIGN(frames.max_disparity, disparities_from(*frames.rig, options.near_m));
    }
    frames.wants = {.color = true, .depth = true};
  }
  frames.wants.confidence = files_of(options).has(FrameOutput::kConfidence);
  DUO_TRY_ASSIGN(frames.rows, rows_of(options, frames, input.pairs->live()));
  Progress progress(app, 0, options.quiet);
  frames.progress = [&progress](double done) { progress.part(done); };
  DUO_TRY_ASSIGN(Pipeline pipeline, Pipeline::open(std::move(input.pairs), std::move(setup)));
  DUO_TRY(look_at(pipeline, options));
  DUO_TRY_ASSIGN(const Summary summary, process(pipeline, options, app, progress));
  progress.end();
  print(summary, pipeline, options);
  // What a live source has to say was said as it came.
  const std::string warning = pipeline.live() ? summary.far_warning : all_warnings(summary, pipeline);
  if (!warning.empty()) say(app, "warning: " + warning);
  return summary.end == Next::kCut ? Exit::kCut : Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("depth", "Disparity, depth and points of pictures or videos");
  const auto options = std::make_shared<Options>();
  sub->add_option("LEFT", options->input.left, "Picture or video of the left camera, a recording, or one file with both views")
      ->required();
  sub->add_option("RIGHT", options->input.right, "Picture or video of the right camera");
  sub->add_option(
      "--rig", options->input.rig,
      "Calibration (our JSON, OpenCV's YAML or JSON); without it, and in no recording that has one, the pair is taken "
      "as rectified");
  options->input.add_to(*sub);
  CLI::Option* most = sub->add_option("--max-disparity", options->max_disparity, "Searches 0 .. N-1 px")
                          ->type_name("N")
                          ->check(within(1, Engine::kMaxDisparity))
                          ->capture_default_str();
  sub->add_option("--near", options->near_m, "Searches as far as something at this distance needs, by the rig")
      ->type_name("METRES")
      ->check(above_zero())
      ->excludes(most);
  sub->add_option("--far", options->far_m,
                  "Nothing farther than this in depth.png and cloud.ply; far points are the least sure")
      ->type_name("METRES")
      ->check(above_zero());
  sub->add_option("--outputs", options->outputs,
                  "What to write, separated by commas; without it all but confidence and depth-video. See docs/formats.md")
      ->delimiter(',')
      ->check(CLI::IsMember(std::vector<std::string>(kFrameOutputNames.begin(), kFrameOutputNames.end())))
      ->type_name("KINDS");
  add_choice_option(*sub, "--axes", options->axes, kAxesNames, "Coordinate system of cloud.ply, see docs/formats.md");
  sub->add_option("-o,--output", options->folder, "Folder for the results")->type_name("DIR")->capture_default_str();
  sub->add_option("--every", options->every, "Of a video, only every N-th frame")
      ->type_name("N")
      ->check(within(std::int64_t{1}, std::int64_t{1} << 40))
      ->capture_default_str();
  sub->add_option("--frames", options->range,
                  "Of a video, only frames A .. B-1, the same bits as in a run of all; either may be left out")
      ->type_name("A:B")
      ->check(CLI::Validator(
          [](std::string& text) {
            parse_range(text);
            return std::string();
          },
          ""));
  add_window_option(
      *sub, "--window",
      "Only these pixels of the rectified left picture matter, with the values they would have without it; may be "
      "repeated",
      [options](Window window) { options->windows.push_back(window); });
  add_strict_option(*sub, options->check);
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
