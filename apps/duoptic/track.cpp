// duoptic track: two videos or cameras and three clicks in, the arm in 3D out.
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>

#include "arm_run.h"
#include "interrupt.h"
#include "progress.h"
#include "recording.h"
#include "rig_report.h"
#include "sink_options.h"
#include "skew_watch.h"
#include "timing.h"

namespace duo::app::track {
namespace {

constexpr char kFooter[] =
    "Clicks are pixels of the raw left picture at --at-frame; tracking starts there. Prints JSON lines: a header, then a line "
    "a\n"
    "frame with each joint's place in metres (rig frame: x right, y down, z forward), its place in the raw left picture, its\n"
    "state (seen, inferred = hidden but known within sigma, lost) and one standard deviation. Two runs give the same bytes.\n"
    "Cameras run until Ctrl-C, which ends the files; a frame that comes too late is left out (skew_ms: the right picture's\n"
    "time after the left's).\n\n"
    "Examples:\n"
    "  duoptic track left.avi right.avi --rig rig.json --select hand=451,360 --select elbow=478,285 --select shoulder=446,201\n"
    "  duoptic track left.avi right.avi --rig rig.json --at-frame 40 --select hand=.. --select elbow=.. --select shoulder=.. "
    "\\\n"
    "      --select2 hand=.. --select2 elbow=.. --select2 shoulder=.. -o arms.jsonl --video arms.mp4\n"
    "  duoptic track clip.mkv --select hand=.. --select elbow=.. --select shoulder=.. --realtime --vmc 127.0.0.1:39539 \\\n"
    "      --bvh arm.bvh --csv arm.csv -o arm.jsonl                       a recording, with its own rig, to an avatar and to "
    "files\n"
    "  duoptic track camera:0 camera:2 --rig rig.json --at-frame 60 --select ...   (duoptic cameras tells the names)\n"
    "  duoptic track camera:0 camera:2 --rig rig.json --select ... --record clip.mkv -o clip.jsonl   both pictures and arm";

struct Options {
  std::string left, right, rig, record;
  std::vector<std::string> select, select2;
  std::int64_t at_frame = 0;
  double skew_ms = 0;
  bool force = false, stats = false, quiet = false, realtime = false;
  ArmOptions arm;
  SinkOptions sinks;
};

using Click = ArmSelection::Click;

/// "hand=451,360" as the joint's index and where it is.
std::pair<std::size_t, Click> parse_click(const char* option, const std::string& text) {
  const std::string_view all = text;
  const std::size_t equals = std::min(all.find('='), all.size()), comma = std::min(all.find(',', equals), all.size());
  const auto number = [](std::string_view part, double& out) {
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), out);
    return error == std::errc() && end == part.data() + part.size() && std::isfinite(out);
  };
  Click click;
  if (comma == all.size() || !number(all.substr(equals + 1, comma - equals - 1), click.x_px) ||
      !number(all.substr(comma + 1), click.y_px))
    throw CLI::ValidationError(option, fmt::format("'{}' is not JOINT=X,Y with two numbers", text));
  for (std::size_t j = 0; j < kArmJoints; ++j)
    if (all.substr(0, equals) == kJointNames[j]) return {j, click};
  throw CLI::ValidationError(option,
                             fmt::format("no joint '{}'; there are: {}", all.substr(0, equals), fmt::join(kJointNames, ", ")));
}

ArmSelection parse_selection(const char* option, const std::vector<std::string>& texts) {
  std::array<std::optional<Click>, kArmJoints> found;
  for (const std::string& text : texts) {
    const auto [joint, click] = parse_click(option, text);
    if (found[joint]) throw CLI::ValidationError(option, fmt::format("{} is given twice", kJointNames[joint]));
    found[joint] = click;
  }
  ArmSelection selection;
  for (std::size_t j = 0; j < kArmJoints; ++j) {
    if (!found[j])
      throw CLI::ValidationError(
          option, fmt::format("{} is missing; give {}=X,Y of each: {}", kJointNames[j], option, fmt::join(kJointNames, ", ")));
    selection.clicks[j] = *found[j];
  }
  return selection;
}

std::vector<ArmSelection> selections(const Options& options) {
  std::vector<ArmSelection> arms = {parse_selection("--select", options.select)};
  if (!options.select2.empty()) arms.push_back(parse_selection("--select2", options.select2));
  return arms;
}

/// Says what happens to live cameras, once, to the engine, and to the recording.
class Events {
 public:
  explicit Events(const CLI::App& app) : app_(app) {}
  void see(const std::string& warning) {
    if (warning != said_ && !warning.empty()) say(app_, warning);
    said_ = warning;
  }
  void happened(const std::string& event) {
    if (!event.empty()) say(app_, "warning: " + event);
  }
  void look_at(const Recording& recording) {
    const auto failure = recording_failed_ ? std::nullopt : recording.failure();
    if (!failure) return;
    say(app_, fmt::format("warning: {}; tracking goes on", failure->what));
    recording_failed_ = true;
  }

 private:
  const CLI::App& app_;
  std::string said_;
  bool recording_failed_ = false;
};

/// As ArmRun::next(), but waits for live cameras that are away and ends with Ctrl-C.
Result<Next> next_frame(ArmRun& run, Events& events) {
  while (true) {
    if (Interrupt::asked()) return Next::kEnd;
    DUO_TRY_ASSIGN(const Next next, run.next());
    if (run.header().live) events.see(run.frames().warning());
    if (next == Next::kPicture) events.happened(run.frames().last().event);
    if (next != Next::kNothing) return next;
  }
}

/// The frame in which joints are selected.
Result<void> first_frame(ArmRun& run, Events& events, std::int64_t number, const std::string& left) {
  DUO_TRY_ASSIGN(const Next next, next_frame(run, events));
  if (next == Next::kPicture) return {};
  if (Interrupt::asked())
    return Error{ErrorCode::kBadInput,
                 fmt::format("stopped before frame {}, the one to select in, came from {}", number, left)};
  const std::int64_t read = run.frames().read();
  return Error{ErrorCode::kBadInput, fmt::format("cannot select at frame {}: {} gives {} pair{}, numbered from 0", number, left,
                                                 read, read == 1 ? "" : "s")};
}

struct Summary {
  static constexpr std::size_t kTimes = 100'000;  // of the first frames; cameras may run for days
  std::size_t frames = 0;
  std::vector<double> engine_ms, tracker_ms, latency_ms;  // latency: live, from capture to all sinks
  Next end = Next::kEnd;
  std::string dropped;  // by each sink that did
};

/// Tracks from the first frame to the end of the files, or to Ctrl-C.
Result<Summary> track_all(ArmRun& run, Events& events, const Recording& recording, const std::vector<ArmSelection>& arms,
                          const Options& options, const CLI::App& app) {
  DUO_TRY(run.select(arms));
  DUO_TRY_ASSIGN(const auto sinks, options.sinks.make(run.header(), run.frames().live(), app));
  Summary summary;
  Progress progress(app, run.frames().count(), options.quiet);
  SkewWatch skew(run.header().rectified.baseline_m);
  while (true) {
    TrackedFrame frame = run.tracked(run.track());
    if (options.stats) frame.times = run.times();
    for (const auto& [name, sink] : sinks) DUO_TRY(sink->write(frame));
    if (summary.frames++ < Summary::kTimes) {
      summary.engine_ms.push_back(run.times().engine_ms);
      summary.tracker_ms.push_back(run.times().tracker_ms);
      if (run.header().live)
        summary.latency_ms.push_back(clock_ms(CLOCK_MONOTONIC) - static_cast<double>(frame.left.t_ns) * 1e-6);
    }
    progress.frame(frame.number + 1);
    events.look_at(recording);
    if (const auto warning = run.header().live ? skew.see(frame) : std::nullopt) say(app, "warning: " + *warning);
    DUO_TRY_ASSIGN(summary.end, next_frame(run, events));
    if (summary.end != Next::kPicture) break;
  }
  for (const auto& [name, sink] : sinks) DUO_TRY(sink->finish());
  summary.dropped = dropped_text(sinks);
  return summary;
}

std::string text_of(const Summary& summary, double seconds, const ArmRun& run, const Options& options) {
  const std::size_t frames = summary.frames;
  const std::string dropped =
      run.header().live ? fmt::format(", {} dropped, latency {:.1f} ms", run.frames().dropped(), median(summary.latency_ms))
                        : std::string();
  return fmt::format(
      "{} frame{} of {}x{} in {:.1f} s = {:.1f} frames/s{}; engine {:.1f} ms, tracker {:.1f} ms ({}, {}, {} thread{}){}",
      frames, frames == 1 ? "" : "s", run.header().size.width, run.header().size.height, seconds,
      static_cast<double>(frames) / seconds, dropped, median(summary.engine_ms), median(summary.tracker_ms),
      run.header().engine, run.header().tracker_preset, options.arm.engine.threads, options.arm.engine.threads == 1 ? "" : "s",
      summary.dropped);
}

Result<Exit> run(const Options& options, const CLI::App& app) {
  const std::vector<ArmSelection> arms = selections(options);
  std::optional<Rig> rig;
  if (!options.rig.empty()) {
    DUO_TRY_ASSIGN(rig, load_rig(options.rig));
  }
  DUO_TRY_ASSIGN(Input input, open_input(options.left, options.right, rig, options.skew_ms));
  if (!input.rig) throw CLI::RequiredError("--rig");  // most sources do not bring their own
  if (options.realtime && !input.pairs->live()) input.pairs = in_real_time(std::move(input.pairs));
  Recording recording;  // before what reads the pairs
  if (!options.record.empty()) {
    DUO_TRY(recording.start(options.record, {.frame_s = input.pairs->frame_s(),
                                             .rig = input.rig,
                                             .date = input.pairs->live() ? date_now() : "",
                                             .replace = options.force}));
    input.pairs = std::make_unique<Tap>(std::move(input.pairs), recording);
  }
  ArmOptions arm = options.arm;
  arm.all_maps = !options.sinks.video.empty();
  arm.in_bulk = true;
  DUO_TRY_ASSIGN(ArmRun run, ArmRun::open(std::move(input), arm, options.at_frame));
  std::optional<Interrupt> interrupt;
  if (run.header().live) interrupt.emplace();
  Events events(app);
  DUO_TRY(first_frame(run, events, options.at_frame, options.left));
  Result<Summary> summary = Summary{};
  const Times times = timed([&] { summary = track_all(run, events, recording, arms, options, app); });
  recording.stop();
  if (!summary) return summary.error();
  // stdout belongs to the lines when they go there.
  if (options.stats)
    say(app, text_of(*summary, times.wall_ms / 1000, run, options));
  else if (!options.quiet && !options.sinks.lines.empty())
    fmt::print("{}\n", text_of(*summary, times.wall_ms / 1000, run, options));
  if (const std::string warning = run.frames().warning(); !run.header().live && !warning.empty())
    say(app, "warning: " + warning);
  if (const auto failure = recording.failure()) return *failure;
  return summary->end == Next::kCut ? Exit::kCut : Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub =
      app.add_subcommand("track", "An arm in 3D through two videos or live, from a click on hand, elbow and shoulder");
  const auto options = std::make_shared<Options>();
  sub->add_option("LEFT", options->left,
                  "Video of the left camera, or the camera itself (camera:0, /dev/video0, http://, rtsp://, gst:);\nalone: a "
                  "recording, both views side by side, or the synthetic person")
      ->required();
  sub->add_option("RIGHT", options->right, "The same of the right camera");
  sub->add_option("--rig", options->rig, "Calibration (our JSON, OpenCV's YAML or JSON); a recording may bring its own");
  sub->add_option("--select", options->select, "Where hand, elbow and shoulder are; once for each")
      ->type_name("JOINT=X,Y")
      ->required();
  sub->add_option("--select2", options->select2, "The same of a second arm, which the lines call joints2")
      ->type_name("JOINT=X,Y");
  sub->add_option("--at-frame", options->at_frame, "The frame of the clicks; those before it are skipped")
      ->type_name("N")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 40))
      ->capture_default_str();
  add_skew_option(*sub, options->skew_ms);
  options->sinks.add_to(*sub);
  CLI::Option* record =
      sub->add_option("--record", options->record,
                      "Record the pairs on their way, also those that come too late to be tracked; track takes the file again")
          ->type_name("FILE.mkv");
  sub->add_flag("--force", options->force, "Replace an earlier recording of that name")->needs(record);
  sub->add_flag("--realtime", options->realtime,
                "Take files at the pace of their capture times, as if live: late pairs are dropped");
  options->arm.add_to(*sub);
  sub->add_flag("--stats", options->stats, "Add times to each line and print a summary of them on stderr");
  sub->add_flag("--quiet", options->quiet, "No progress and no summary");
  sub->footer(kFooter);
  return {sub, [options, sub] { return run(*options, *sub); }};
}

}  // namespace duo::app::track
