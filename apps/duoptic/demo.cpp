// duoptic demo: the synthetic room through the whole of depth and a person's arm through the tracker, with accuracy and speed
// here, and pictures and videos to look at.
#include <fmt/format.h>

#include <array>
#include <limits>
#include <memory>

#include "command.h"
#include "duoptic/frame_files.h"
#include "duoptic/interrupt.h"
#include "duoptic/output_set.h"
#include "duoptic/paint.h"
#include "duoptic/reports.h"
#include "duoptic/sink.h"
#include "duoptic/synthetic.h"
#include "duoptic/timing.h"
#include "eval_clip.h"
#include "progress.h"

namespace duo::app::demo {
namespace {

struct Options {
  std::string folder = "demo";
  EngineOptions engine;
};

struct Run {
  std::unique_ptr<Engine> engine;
  std::shared_ptr<const Frame> frame;
  Times times;
};

Result<Run> run_on(const SyntheticPair& input, bool with_rig, const EngineOptions& options) {
  Run out;
  DUO_TRY_ASSIGN(out.engine, make_engine(options.engine, options.threads));
  Setup setup = options.setup();
  setup.size = input.pair.left.pixels.size();
  if (with_rig) {
    setup.rig = input.rig;
    setup.wants = {.color = true, .depth = true};
  }
  DUO_TRY(out.engine->prepare(setup));
  constexpr int kRuns = 9;
  std::vector<Times> runs;
  for (int i = 0; i < kRuns; ++i)
    runs.push_back(timed([&] {
      out.engine->submit(input.pair);
      out.frame = out.engine->collect();
    }));
  runs.erase(runs.begin());  // warms caches
  out.times = median_of(runs);
  return out;
}

Result<void> write_pictures(const SyntheticPair& raw, const Run& run, const std::string& folder) {
  const Rectified& rectified = *run.engine->rectified();
  const Image<Rgb8> disparity = draw_disparity(run.frame->disparity.d_q4, &rectified);
  const Image<Rgb8> cloud = draw_cloud(run.frame->disparity.d_q4, run.frame->color, rectified, disparity.size());
  DUO_TRY_ASSIGN(OutputSet out, OutputSet::open(folder));
  DUO_TRY(write_frame(*run.frame, run.engine->rectified(), {}, [&](const std::string& name) { return out / name; }));
  DUO_TRY(write_png(raw.pair.left.pixels, out / "left.png"));
  DUO_TRY(write_png(cloud, out / "cloud.png"));
  DUO_TRY(write_png(side_by_side(std::array<View<const Rgb8>, 3>{raw.pair.left.pixels, disparity, cloud}), out / "demo.png"));
  return out.publish(frame_file_names());
}

void print(const char* what, const RenderedAccuracy& a) {
  fmt::print("{:<44} {:5.1f} % of the pixels, {:4.1f} % of them off by more than 1 px, median depth error {:.2f} %\n", what,
             a.coverage_percent, a.bad_percent, a.depth_error_percent);
}

/// An output that a signal fails.
class Stops final : public Sink {
 public:
  Result<void> write(const TrackedFrame&) override {
    if (Interrupt::asked()) return stopped("the videos were whole");
    return {};
  }
  Result<void> finish() override { return {}; }
};

/// The panels of the frame in which a hand is highest, as a picture.
class RaisedHand final : public Sink {
 public:
  RaisedHand(std::filesystem::path path, TrackHeader header) : path_(std::move(path)), header_(std::move(header)) {}

  Result<void> write(const TrackedFrame& frame) override {
    constexpr double kRoomNearer = 1.3;  // of the range of depths, as hands come nearer than the first frame's surfaces
    if (range_.empty()) range_ = roomy_range(frame.frame->disparity.d_q4, kRoomNearer);
    for (const Person& person : frame.people)
      for (const JointId id : {JointId::kRightHand, JointId::kLeftHand}) {
        const Joint* hand = person.find(id);
        if (hand == nullptr || hand->state != JointState::kSeen || hand->p_in_rig_m.y >= highest_m_) continue;
        highest_m_ = hand->p_in_rig_m.y;
        panels_ = draw_panels(frame, header_, range_);
      }
    return {};
  }
  bool wants_pictures() const override { return true; }
  Result<void> finish() override { return panels_.empty() ? Result<void>() : write_png(panels_, path_); }

 private:
  std::filesystem::path path_;
  TrackHeader header_;
  DisparityRange range_;
  double highest_m_ = std::numeric_limits<double>::infinity();  // y points down
  Image<Rgb8> panels_;
};

/// A person in the room moves an arm, hides its hand behind the back and shows it again; the tracker follows.
Result<void> track_person(const Options& options, const CLI::App& app) {
  const SyntheticClipSetup setup{.script = "behind"};
  fmt::print("\nRendering a person who moves an arm ...\n");
  std::fflush(stdout);
  const std::filesystem::path clip = std::filesystem::path(options.folder) / "clip";
  {
    Progress progress(app, 0, false);
    DUO_TRY(write_clip(setup, clip, options.engine.threads, [&](int done, int) {
      progress.frame(done);
      return !Interrupt::asked();
    }));
  }
  DUO_TRY_ASSIGN(const ClipTruth truth, load_clip(clip));
  std::vector<ClipScore> scores;
  for (const char* tracker : {"body", "arm", "thesis"}) {
    TrackingOptions tracking;
    tracking.engine = options.engine;
    tracking.tracker = tracker;
    DUO_TRY_ASSIGN(PipelineSetup pipeline, eval_clip::setup_of(tracking, clip, truth.rig));
    const auto add_video = [&](Pipeline& to) -> Result<void> {
      const std::string video = (std::filesystem::path(options.folder) / fmt::format("{}.mp4", tracker)).string();
      std::string note;
      DUO_TRY_ASSIGN(auto sink, make_panel_video(video, to.header(), note));
      if (!note.empty()) say(app, "warning: " + note);
      DUO_TRY(to.add_sink("signals", std::make_unique<Stops>()));
      if (tracker == std::string_view("body")) {
        const std::string picture = (std::filesystem::path(options.folder) / "body.png").string();
        DUO_TRY(to.add_sink(picture, std::make_unique<RaisedHand>(picture, to.header())));
      }
      return to.add_sink(video, std::move(sink));
    };
    DUO_TRY_ASSIGN(ClipScore score, score_clip(clip, truth, {.pipeline = std::move(pipeline), .add_sinks = add_video}));
    scores.push_back(std::move(score));
  }
  fmt::print(
      "\nThe whole person without a click against exact joints, mm; beside it the trackers of a clicked arm, ours and the "
      "thesis's of "
      "2010\n");
  fmt::print("{}", text_of(scores));
  fmt::print(
      "\nLook at {0}/body.png and {0}/body.mp4 (joints and bones, depth, body, hue), at {0}/arm.mp4,\n"
      "and how {0}/thesis.mp4 loses the arm.\n",
      options.folder);
  return {};
}

/// What to type next, here and now: this program as it is reached from the working folder, and the clip just rendered.
void print_next(const std::string& folder) {
  std::error_code ignored;
  const std::filesystem::path here =
      std::filesystem::proximate(std::filesystem::read_symlink("/proc/self/exe", ignored), ignored);
  const std::string program = here.empty() || *here.begin() == ".." ? "duoptic" : here.string(), clip = folder + "/clip";
  fmt::print(
      "\nNext: the same person in a window, and as a file of joints\n"
      "  {0} view {1}/left.avi {1}/right.avi --rig {1}/calibration_truth.yml --loop\n"
      "  {0} track {1}/left.avi {1}/right.avi --rig {1}/calibration_truth.yml -o {2}/people.jsonl\n",
      program, clip, folder);
}

Result<Exit> run(const Options& options, const CLI::App& app) {
  fmt::print("Rendering a room with exact depth, seen by two distorted, noisy webcams ...\n");
  std::fflush(stdout);
  const SyntheticPair raw = render_synthetic({}, options.engine.threads);
  const SyntheticPair ideal = render_synthetic({.ideal = true}, options.engine.threads);
  DUO_TRY_ASSIGN(const Run from_raw, run_on(raw, true, options.engine));
  DUO_TRY_ASSIGN(const Run from_ideal, run_on(ideal, false, options.engine));
  DUO_TRY(write_pictures(raw, from_raw, options.folder));

  const Size size = raw.pair.left.pixels.size();
  fmt::print("\nAccuracy against the exact truth, {}x{}\n", size.width, size.height);
  print("  raw webcams (denoise, rectify, match)", raw_accuracy(*from_raw.frame, *from_raw.engine->rectified(), raw));
  print("  ideal cameras (matching alone)", ideal_accuracy(*from_ideal.frame, ideal));
  fmt::print(
      "\nSpeed of the whole way from decoded pictures to depth, {} engine, {} thread{}\n  {:.1f} ms a frame = {:.0f} frames/s, "
      "{:.1f} ms CPU\n",
      from_raw.engine->name(), options.engine.threads, options.engine.threads == 1 ? "" : "s", from_raw.times.wall_ms,
      1000 / from_raw.times.wall_ms, from_raw.times.cpu_ms);
  fmt::print(
      "\nLook at {0}/demo.png (camera, depth with its legend in metres, points from the side);\n"
      "beside it left.png, disparity.png, depth.png (mm), cloud.png and cloud.ply (for a 3D viewer).\n",
      options.folder);
  DUO_TRY(track_person(options, app));
  print_next(options.folder);
  return Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("demo", "A synthetic room and a person in it: accuracy, speed, pictures and videos");
  const auto options = std::make_shared<Options>();
  sub->add_option("-o,--output", options->folder, "Folder for the pictures")->type_name("DIR")->capture_default_str();
  options->engine.add_to(*sub);
  sub->footer("Example:\n  duoptic demo -o demo");
  return {sub, [options, sub] { return run(*options, *sub); }};
}

}  // namespace duo::app::demo
