// duoptic track: two videos or cameras and clicks on joints in, persons in 3D out.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "duoptic/interrupt.h"
#include "duoptic/skew_watch.h"
#include "duoptic/timing.h"
#include "progress.h"
#include "run_news.h"
#include "sink_options.h"
#include "tracking_options.h"

namespace duo::app::track {
namespace {

constexpr char kFooter[] =
    "Without --select people are found by themselves, each with 21 joints. With it an arm is followed: clicks are pixels of "
    "the\n"
    "raw left picture at --at-frame; tracking starts there. Both arms: name the joints of both sides, right_hand=.. and\n"
    "left_hand=... Prints JSON lines: a header, then a line per frame with each joint's place in metres "
    "(rig\n"
    "frame: x right, y down, z forward), its place in the raw left picture, its state (seen, inferred = hidden but known "
    "within\n"
    "sigma, lost) and one standard deviation. Two runs give the same bytes.\n"
    "Cameras run until Ctrl-C, which ends the files; a frame that comes too late is dropped (skew_ms: the right picture's\n"
    "time after the left's).\n\n"
    "Examples:\n"
    "  duoptic track left.avi right.avi --rig rig.json -o people.jsonl --video people.mp4              whole people, no "
    "clicks\n"
    "  duoptic track left.avi right.avi --rig rig.json --select hand=451,360 --select elbow=478,285 --select shoulder=446,201\n"
    "  duoptic track left.avi right.avi --rig rig.json --at-frame 40 --select left_hand=.. --select left_elbow=.. \\\n"
    "      --select left_shoulder=.. --select right_hand=.. --select right_elbow=.. --select right_shoulder=.. -o arms.jsonl\n"
    "  duoptic track clip.mkv --select hand=.. --select elbow=.. --select shoulder=.. --realtime --vmc 127.0.0.1:39539 \\\n"
    "      --bvh arm.bvh --csv arm.csv -o arm.jsonl                       a recording, with its own rig, to an avatar and to "
    "files\n"
    "  duoptic track camera:0 camera:2 --rig rig.json --at-frame 60 --select ...   (duoptic cameras tells the names)\n"
    "  duoptic track camera:0 camera:2 --rig rig.json --select ... --record clip.mkv -o clip.jsonl   both pictures and arm";

struct Options {
  std::string record;
  std::vector<std::string> select;
  std::string arm_side = "right";
  std::int64_t at_frame = 0;
  InputOptions input;
  RigCheck check = RigCheck::kTell;
  double budget_percent = 0;
  bool whole = false, force = false, stats = false, quiet = false, realtime = false;
  TrackingOptions tracking;
  SinkOptions sinks;
};

/// Says what happens to live cameras, to the engine, and to the recording.
class Events {
 public:
  explicit Events(const CLI::App& app) : app_(app), news_(app) {}
  void see(const Pipeline& pipeline, Next next) {
    news_.see(pipeline);
    if (next != Next::kNew) return;
    if (const std::string event = pipeline.event(); !event.empty()) say(app_, "warning: " + event);
  }
  void look_at(const Pipeline& pipeline) {
    const auto failure = recording_failed_ ? std::nullopt : pipeline.recording_failure();
    if (!failure) return;
    say(app_, fmt::format("warning: {}; tracking goes on", failure->what));
    recording_failed_ = true;
  }

 private:
  const CLI::App& app_;
  RunNews news_;
  bool recording_failed_ = false;
};

/// As Pipeline::next(), but waits for live cameras that are away and ends with Ctrl-C.
Result<Next> next_frame(Pipeline& pipeline, Events& events) {
  while (true) {
    if (Interrupt::asked()) return Next::kEnd;
    DUO_TRY_ASSIGN(const Next next, pipeline.next());
    events.see(pipeline, next);
    if (next != Next::kNothing) return next;
  }
}

/// The frame in which joints are selected.
Result<void> first_frame(Pipeline& pipeline, Events& events, std::int64_t number, const std::string& left) {
  DUO_TRY_ASSIGN(const Next next, next_frame(pipeline, events));
  if (next == Next::kNew) return {};
  if (Interrupt::asked())
    return Error{ErrorCode::kBadInput,
                 fmt::format("stopped before frame {}, the one to select in, came from {}", number, left)};
  const std::int64_t read = pipeline.read();
  return Error{ErrorCode::kBadInput, fmt::format("cannot select at frame {}: {} gives {} pair{}, numbered from 0", number, left,
                                                 read, read == 1 ? "" : "s")};
}

struct Summary {
  static constexpr std::size_t kTimes = 100'000;  // of the first frames; cameras may run for days
  std::size_t frames = 0;
  std::vector<double> engine_ms, tracker_ms, latency_ms;  // latency: live, from capture to all sinks
  Next end = Next::kEnd;
};

/// Completes the outputs. The error, that of the run before or the first of theirs, names those that hold its frames all the same.
Result<void> complete_outputs(Pipeline& pipeline, std::size_t frames, Result<void> first = {}) {
  std::vector<std::string> files;
  for (const std::string& name : pipeline.sink_names()) {
    const auto finished = pipeline.finish_sink(name);
    std::error_code none;
    if (finished && std::filesystem::is_regular_file(name, none)) files.push_back(name);
    if (!finished && first) first = finished;
  }
  if (first || files.empty()) return first;
  return Error{first.error().code, fmt::format("{}; {} frame{} {} in {}", first.error().what, frames, frames == 1 ? "" : "s",
                                               frames == 1 ? "is" : "are", fmt::join(files, ", "))};
}

/// A run that fails is worth the `frames` that it has. A rig that was refused leaves nothing, nor does what fails at once.
Error failed_after(Pipeline& pipeline, std::size_t frames, const Error& error, const Options& options) {
  const auto& fit = pipeline.rig_fit();
  const bool refused = options.check == RigCheck::kStrict && fit && !fit->what.empty();
  if (frames > 1 && !refused) return complete_outputs(pipeline, frames, error).error();
  static_cast<void>(pipeline.flush_sinks());  // the first error counts
  return error;
}

/// Tracks from the first frame to the end of the files, or to Ctrl-C.
Result<Summary> track_all(Pipeline& pipeline, Events& events, std::span<const Selection> selections, const Options& options,
                          const CLI::App& app) {
  if (!selections.empty()) DUO_TRY(pipeline.select(selections));
  const bool lines_on_stdout = options.sinks.lines_on_stdout();
  DUO_TRY_ASSIGN(const auto notes, options.sinks.add_all_to(pipeline));
  for (const std::string& note : notes) say(app, "warning: " + note);
  if (lines_on_stdout) DUO_TRY(options.sinks.add_to(pipeline, sink_kinds().front(), ""));
  Summary summary;
  Progress progress(app, pipeline.count(), options.quiet);
  SkewWatch skew(pipeline.header().rectified.baseline_m);
  while (true) {
    if (const auto written = pipeline.write(); !written)
      return failed_after(pipeline, summary.frames + 1, written.error(), options);
    const TrackedFrame frame = pipeline.tracked();
    if (summary.frames++ < Summary::kTimes) {
      summary.engine_ms.push_back(pipeline.times().engine_ms);
      summary.tracker_ms.push_back(pipeline.times().tracker_ms);
      if (pipeline.live())
        summary.latency_ms.push_back(clock_ms(CLOCK_MONOTONIC) - static_cast<double>(frame.left->t_ns) * 1e-6);
    }
    progress.frame(frame.number + 1);
    events.look_at(pipeline);
    if (const auto warning = pipeline.live() ? skew.see(frame) : std::nullopt) say(app, "warning: " + *warning);
    const Result<Next> next = next_frame(pipeline, events);
    if (!next) return failed_after(pipeline, summary.frames, next.error(), options);
    summary.end = *next;
    if (summary.end != Next::kNew) break;
  }
  DUO_TRY(complete_outputs(pipeline, summary.frames));
  return summary;
}

std::string text_of(const Summary& summary, double seconds, const Pipeline& pipeline, const Options& options) {
  const std::size_t frames = summary.frames;
  const std::string dropped =
      pipeline.live() ? fmt::format(", {} dropped, latency {:.1f} ms", pipeline.dropped(), median_of(summary.latency_ms))
                      : std::string();
  return fmt::format(
      "{} frame{} of {}x{} in {:.1f} s = {:.1f} frames/s{}; engine {:.1f} ms, tracker {:.1f} ms ({}, {}, {} thread{}){}",
      frames, frames == 1 ? "" : "s", pipeline.header().size.width, pipeline.header().size.height, seconds,
      static_cast<double>(frames) / seconds, dropped, median_of(summary.engine_ms), median_of(summary.tracker_ms),
      pipeline.header().engine, pipeline.header().tracker, options.tracking.engine.threads,
      options.tracking.engine.threads == 1 ? "" : "s", dropped_text(pipeline));
}

Result<Exit> run(const Options& options, const CLI::App& app) {
  TrackingOptions tracking = options.tracking.or_tracker(options.select.empty() ? "body" : "arm");
  DUO_TRY_ASSIGN(const auto tracker, make_tracker(tracking.tracker));
  if (options.select.empty() && !tracker->starts_by_itself()) throw CLI::RequiredError("--select");
  if (!options.select.empty() && tracker->starts_by_itself())
    throw CLI::ValidationError(
        "--select", fmt::format("the tracker {} finds people by itself; leave out --select, or --tracker {}", tracker->name(),
                                tracker->name()));
  const auto selections = parse_selections(options.select, options.arm_side, tracker->skeletons());
  if (!selections) throw CLI::ValidationError("--select", selections.error().what);
  DUO_TRY_ASSIGN(Input input, options.input.open());
  if (!input.rig) throw CLI::RequiredError("--rig");  // most sources do not bring their own
  if (options.realtime && !input.pairs->live()) input.pairs = in_real_time(std::move(input.pairs));
  if (options.budget_percent > 0 && !input.pairs->live())
    throw CLI::ValidationError("--budget",
                               "files are tracked as fast as can be, and no pair of theirs is left out; add --realtime");
  const RecorderSetup to_record{.frame_s = input.pairs->frame_s(),
                                .rig = input.rig,
                                .date = input.pairs->live() ? date_now() : "",
                                .replace = options.force};
  tracking.all_maps = options.sinks.wants_maps();
  tracking.in_bulk = true;
  if (tracking.focus == PeopleFocus::kOff && !options.whole && !options.sinks.writes_depth())
    tracking.focus = PeopleFocus::kWherePossible;
  DUO_TRY_ASSIGN(PipelineSetup setup, tracking.setup(input));
  setup.first = options.at_frame;
  setup.tell_times = options.stats;
  setup.check = options.check;
  setup.budget_percent = options.budget_percent;
  DUO_TRY_ASSIGN(Pipeline pipeline, Pipeline::open(std::move(input.pairs), std::move(setup)));
  if (!options.record.empty()) DUO_TRY(pipeline.record(options.record, to_record));
  if (pipeline.live()) Interrupt::is_the_end();
  Events events(app);
  DUO_TRY(first_frame(pipeline, events, options.at_frame, options.input.left));
  Result<Summary> summary = Summary{};
  const Times times = timed([&] { summary = track_all(pipeline, events, *selections, options, app); });
  pipeline.stop_recording();
  if (!summary) return summary.error();
  // stdout belongs to the lines when they go there.
  if (options.stats)
    say(app, text_of(*summary, times.wall_ms / 1000, pipeline, options));
  else if (!options.quiet && !options.sinks.on_stdout())
    fmt::print("{}\n", text_of(*summary, times.wall_ms / 1000, pipeline, options));
  if (const std::string warning = pipeline.warning(); !pipeline.live() && !warning.empty()) say(app, "warning: " + warning);
  if (const auto failure = pipeline.recording_failure()) return *failure;
  return summary->end == Next::kCut ? Exit::kCut : Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand(
      "track", "People in 3D through two videos or live; or an arm, from a click on hand, elbow and shoulder");
  const auto options = std::make_shared<Options>();
  sub->add_option("LEFT", options->input.left,
                  "Video of the left camera, or the camera itself (camera:0, /dev/video0, http://, rtsp://, gst:);\nalone: a "
                  "recording, one file with both views, or the synthetic person")
      ->required();
  sub->add_option("RIGHT", options->input.right, "The same of the right camera");
  sub->add_option("--rig", options->input.rig, "Calibration (our JSON, OpenCV's YAML or JSON); a recording may bring its own");
  sub->add_option(
         "--select", options->select,
         "Follow an arm instead: where hand, elbow and shoulder are, once for each; of both arms with their sides, left_hand")
      ->type_name("JOINT=X,Y");
  sub->add_option("--arm", options->arm_side, "The arm that is meant where --select says no side: the person's own")
      ->check(CLI::IsMember({"left", "right"}))
      ->capture_default_str();
  sub->add_option("--at-frame", options->at_frame, "The frame of the clicks; those before it are skipped")
      ->type_name("N")
      ->check(within(std::int64_t{0}, std::int64_t{1} << 40))
      ->capture_default_str();
  options->input.add_to(*sub);
  options->sinks.add_to(*sub);
  CLI::Option* record =
      sub->add_option("--record", options->record,
                      "Record the pairs on their way, also those that come too late to be tracked; track takes the file again")
          ->type_name("FILE.mkv");
  sub->add_flag("--force", options->force, "Replace an earlier recording of that name")->needs(record);
  sub->add_flag("--realtime", options->realtime,
                "Take files at the pace of their capture times, as if live: late pairs are dropped");
  sub->add_option(
         "--budget", options->budget_percent,
         "Of live sources: take no more CPU time than this, 100 being one core; pairs are left out for it, and counted\n"
         "as dropped, but one a second")
      ->type_name("PERCENT")
      ->check(within(1.0, 100'000.0));
  add_strict_option(*sub, options->check);
  options->tracking.add_to(*sub);
  sub->add_flag("--whole", options->whole, "Match each frame as a whole, not around people alone")->excludes("--focus");
  sub->add_flag("--stats", options->stats, "Add times to each line and print a summary of them on stderr");
  sub->add_flag("--quiet", options->quiet, "No progress and no summary");
  sub->footer(kFooter);
  return {sub, [options, sub] { return run(*options, *sub); }};
}

}  // namespace duo::app::track
