// duoptic record: pairs of two cameras, or of whatever gives pairs, into one file.
#include <fmt/format.h>

#include <memory>

#include "duoptic/interrupt.h"
#include "duoptic/pipeline.h"
#include "duoptic/reports.h"
#include "duoptic/timing.h"
#include "input.h"
#include "progress.h"
#include "run_news.h"

namespace duo::app::record {
namespace {

constexpr char kFooter[] =
    "One Matroska file with two video tracks that ordinary players open: JPEG as the cameras delivered it, other pictures as\n"
    "FFV1, nothing lost; capture times to the nanosecond and the rig are in it. Written under its name from the first pair\n"
    "on: after a crash, a full disk or Ctrl-C all pairs up to then are there. Every command that takes LEFT takes a recording "
    "alone.\n\n"
    "Examples:\n"
    "  duoptic record camera:0 camera:2 --rig rig.json -o clip.mkv              until Ctrl-C\n"
    "  duoptic record camera:0 camera:2 --rig rig.json -o clip.mkv --seconds 10\n"
    "  duoptic record left.avi right.avi --rig rig.json -o clip.mkv             two videos as one file\n"
    "  duoptic track clip.mkv --select hand=.. --select elbow=.. --select shoulder=..";

struct Options {
  std::string output;
  InputOptions input;
  double seconds = 0;  // 0: to the end, or until Ctrl-C
  RigCheck check = RigCheck::kTell;
  bool force = false, json = false, quiet = false;
};

/// Up to the end of the source, the time that was asked for, or Ctrl-C. Live, that time is the clock's: cameras may be away.
Result<Next> record_all(Pipeline& pipeline, const Options& options, const CLI::App& app) {
  const double start_ms = clock_ms(CLOCK_MONOTONIC);
  if (pipeline.live()) Interrupt::is_the_end();
  const bool by_clock = pipeline.live() && options.seconds > 0;
  constexpr double kGrace_ms = 300;  // the last pairs are on their way
  Progress progress(app, pipeline.count(), options.quiet);
  RunNews news(app);
  Next next = Next::kNew;
  while (!Interrupt::asked() && pipeline.recording().on && next != Next::kEnd && next != Next::kCut) {
    const Result<Next> got = pipeline.next();
    if (!got) {
      pipeline.stop_recording();
      const std::int64_t pairs = pipeline.recording().pairs;
      if (pairs == 0 || pipeline.recording_failure()) return got.error();
      return Error{got.error().code, fmt::format("{}; {} has the {} pair{} before", got.error().what, options.output, pairs,
                                                 pairs == 1 ? "" : "s")};
    }
    next = *got;
    news.see(pipeline);
    progress.frame(pipeline.recording().pairs);
    if (by_clock && clock_ms(CLOCK_MONOTONIC) - start_ms >= options.seconds * 1000 + kGrace_ms) break;
  }
  pipeline.stop_recording();
  if (const auto failure = pipeline.recording_failure()) return *failure;
  return next;
}

void print(const Pipeline& pipeline, const Options& options, Next end, bool rig) {
  const RecordingStatus done = pipeline.recording();
  const Size size = pipeline.setup().size;
  if (options.json) {
    print_json({{"file", options.output},
                {"pairs", done.pairs},
                {"width", size.width},
                {"height", size.height},
                {"length_s", done.length_s},
                {"bytes", done.bytes},
                {"codecs", done.codecs},
                {"dropped", done.dropped},
                {"rig", rig},
                {"cut", end == Next::kCut},
                {"warning", pipeline.warning()},
                {"rig_fit", nlohmann::json::parse(json_of(pipeline.rig_fit()))}});
  } else if (!options.quiet) {
    fmt::print("{}: {} pair{} of {}x{} in {:.1f} s, {}, {:.1f} MB, {} rig{}\n", options.output, done.pairs,
               done.pairs == 1 ? "" : "s", size.width, size.height, done.length_s, done.codecs,
               static_cast<double>(done.bytes) * 1e-6, rig ? "with" : "no",
               done.dropped > 0 ? fmt::format(", {} dropped", done.dropped) : "");
  }
}

Result<Exit> run(const Options& options, const CLI::App& app) {
  RecorderSetup setup;
  DUO_TRY_ASSIGN(Input input, options.input.open());
  setup.rig = input.rig;
  setup.frame_s = input.pairs->frame_s();
  setup.replace = options.force;
  if (input.pairs->live()) setup.date = date_now();
  PipelineSetup of_pairs{.engine = "", .check = options.check};
  of_pairs.frames.rig = setup.rig;
  DUO_TRY_ASSIGN(Pipeline pipeline, Pipeline::open(std::move(input.pairs), std::move(of_pairs)));
  DUO_TRY(pipeline.record(options.output, setup, options.seconds));
  DUO_TRY_ASSIGN(const Next end, record_all(pipeline, options, app));
  if (pipeline.recording().pairs == 0)
    return Error{ErrorCode::kBadInput, fmt::format("nothing recorded: {} gave no pair; no file was made", options.input.left)};
  print(pipeline, options, end, setup.rig.has_value());
  if (const std::string warning = pipeline.warning(); !pipeline.live() && !warning.empty()) say(app, "warning: " + warning);
  return end == Next::kCut ? Exit::kCut : Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("record", "Two cameras into one file that players open, with capture times and rig");
  const auto options = std::make_shared<Options>();
  sub->add_option("LEFT", options->input.left, "Left camera or video, or what gives both views")->required();
  sub->add_option("RIGHT", options->input.right, "Right camera or video");
  sub->add_option("-o,--output", options->output, "The recording, NAME.mkv")->type_name("FILE")->required();
  sub->add_option("--rig", options->input.rig, "Calibration to keep in the recording; else the source's own")
      ->type_name("FILE");
  options->input.add_to(*sub);
  sub->add_option("--seconds", options->seconds, "How long; without it to the end, or until Ctrl-C")
      ->type_name("S")
      ->check(above_zero());
  add_strict_option(*sub, options->check);
  sub->add_flag("--force", options->force, "Replace a file of that name");
  sub->add_flag("--json", options->json, "Print the summary as JSON");
  sub->add_flag("--quiet", options->quiet, "No progress and no summary");
  sub->footer(kFooter);
  return {sub, [options, sub] { return run(*options, *sub); }};
}

}  // namespace duo::app::record
