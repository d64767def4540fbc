// duoptic record: pairs of two cameras, or of whatever gives pairs, into one file.
#include "duoptic/recording.h"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "duoptic/source.h"
#include "input.h"
#include "interrupt.h"
#include "progress.h"
#include "rig_report.h"

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
  std::string left, right, output, rig;
  double skew_ms = 0, seconds = 0;  // 0: to the end, or until Ctrl-C
  bool force = false, json = false, quiet = false;
};

struct Summary {
  Next end = Next::kEnd;
  double length_s = 0;  // from the first pair's capture to the last one's
};

/// Up to the end of the source, the time that was asked for, or Ctrl-C.
Result<Summary> record_all(PairSource& pairs, Recorder& recorder, const Options& options, const CLI::App& app) {
  const Interrupt interrupt;
  Progress progress(app, pairs.count(), options.quiet);
  Summary summary;
  TimeNs start_ns = 0;
  for (Pair pair; !Interrupt::asked();) {
    DUO_TRY_ASSIGN(summary.end, pairs.next(pair));
    if (summary.end == Next::kNothing) continue;
    if (summary.end != Next::kPicture) break;
    if (recorder.pairs() == 0) start_ns = pair.left.t_ns;
    const double t_s = static_cast<double>(pair.left.t_ns - start_ns) * 1e-9;
    if (options.seconds > 0 && t_s >= options.seconds) break;
    summary.length_s = t_s;
    DUO_TRY(recorder.write(pair));
    progress.frame(recorder.pairs());
  }
  DUO_TRY(recorder.finish());
  return summary;
}

void print(const Summary& summary, const Recorder& recorder, const PairSource& pairs, const Options& options, bool rig) {
  if (options.json) {
    const nlohmann::json out = {
        {"file", options.output},           {"pairs", recorder.pairs()},    {"width", pairs.size().width},
        {"height", pairs.size().height},    {"length_s", summary.length_s}, {"bytes", recorder.bytes()},
        {"codecs", recorder.codecs()},      {"dropped", pairs.dropped()},   {"rig", rig},
        {"cut", summary.end == Next::kCut}, {"warning", pairs.warning()}};
    fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else if (!options.quiet) {
    fmt::print("{}: {} pair{} of {}x{} in {:.1f} s, {}, {:.1f} MB, {} rig{}\n", options.output, recorder.pairs(),
               recorder.pairs() == 1 ? "" : "s", pairs.size().width, pairs.size().height, summary.length_s, recorder.codecs(),
               static_cast<double>(recorder.bytes()) * 1e-6, rig ? "with" : "no",
               pairs.dropped() > 0 ? fmt::format(", {} dropped", pairs.dropped()) : "");
  }
}

Result<Exit> run(const Options& options, const CLI::App& app) {
  RecorderSetup setup;
  if (!options.rig.empty()) {
    DUO_TRY_ASSIGN(setup.rig, load_rig(options.rig));
  }
  DUO_TRY_ASSIGN(const Input input, open_input(options.left, options.right, setup.rig, options.skew_ms));
  const auto& pairs = input.pairs;
  setup.rig = input.rig;
  setup.frame_s = pairs->frame_s();
  setup.replace = options.force;
  if (pairs->live()) setup.date = date_now();
  if (setup.rig && setup.rig->left.size != pairs->size())
    return Error{
        ErrorCode::kBadInput,
        fmt::format("cannot record {} with this rig: it is of pictures of {}x{}, these have {}x{}", options.left,
                    setup.rig->left.size.width, setup.rig->left.size.height, pairs->size().width, pairs->size().height)};
  DUO_TRY_ASSIGN(Recorder recorder, Recorder::open(options.output, setup));
  DUO_TRY_ASSIGN(const Summary summary, record_all(*pairs, recorder, options, app));
  if (recorder.pairs() == 0)
    return Error{ErrorCode::kBadInput, fmt::format("nothing recorded: {} gave no pair; no file was made", options.left)};
  print(summary, recorder, *pairs, options, setup.rig.has_value());
  if (const std::string warning = pairs->warning(); !warning.empty()) say(app, "warning: " + warning);
  return summary.end == Next::kCut ? Exit::kCut : Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("record", "Two cameras into one file that players open, with capture times and rig");
  const auto options = std::make_shared<Options>();
  sub->add_option("LEFT", options->left, "Left camera or video, or what gives both views")->required();
  sub->add_option("RIGHT", options->right, "Right camera or video");
  sub->add_option("-o,--output", options->output, "The recording, NAME.mkv")->type_name("FILE")->required();
  sub->add_option("--rig", options->rig, "Calibration to keep in the recording; else the source's own")->type_name("FILE");
  add_skew_option(*sub, options->skew_ms);
  sub->add_option("--seconds", options->seconds, "How long; without it to the end, or until Ctrl-C")
      ->type_name("S")
      ->check(CLI::PositiveNumber);
  sub->add_flag("--force", options->force, "Replace a file of that name");
  sub->add_flag("--json", options->json, "Print the summary as JSON");
  sub->add_flag("--quiet", options->quiet, "No progress and no summary");
  sub->footer(kFooter);
  return {sub, [options, sub] { return run(*options, *sub); }};
}

}  // namespace duo::app::record
