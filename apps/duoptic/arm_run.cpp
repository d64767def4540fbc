#include "arm_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "timing.h"

namespace duo::app {
namespace {

/// As far as `z_m` needs, but no farther than every matcher can search: a large picture starts at a greater depth.
int disparity_at(double z_m, const Rig& rig) {
  constexpr int kMost = 256;
  const double d_px = rig.left.fx_px * rig.baseline_m() / z_m;
  return std::clamp((static_cast<int>(d_px) / 16 + 1) * 16, 16, kMost);
}

}  // namespace

void ArmOptions::add_to(CLI::App& app) {
  engine.add_to(app);
  app.add_option("--max-disparity", max_disparity,
                 fmt::format("Searches 0 .. N-1 px; without it, as far as {} m needs, 256 at most", ArmRun::kNearest_m))
      ->type_name("N")
      ->check(CLI::Range(1, Engine::kMaxDisparity));
  app.add_option("--tracker", tracker, "arm: hand, elbow and shoulder, through hiding; thesis: three blobs as in 2010")
      ->check(CLI::IsMember(tracker_names()))
      ->capture_default_str();
}

Result<ArmRun> ArmRun::open(Input input, const ArmOptions& options, std::int64_t first) {
  ArmRun run;
  DUO_TRY_ASSIGN(run.engine_, make_engine(options.engine.engine, options.engine.threads));
  Setup& setup = run.setup_;
  setup = options.engine.setup();
  setup.size = input.pairs->size();
  setup.rig = input.rig;
  if (!setup.rig)
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot find joints in space with {}: it does not bring a rig; give one with "
                             "--rig",
                             input.names[0])};
  const Rig& rig = *setup.rig;
  setup.max_disparity = options.max_disparity > 0 ? options.max_disparity : disparity_at(kNearest_m, rig);
  DUO_TRY_ASSIGN(run.tracker_, make_tracker(options.tracker));
  setup.wants = run.tracker_->wants();
  if (options.all_maps) setup.wants.color = setup.wants.views = setup.wants.disparity = true;
  setup.many_at_once = options.in_bulk && !input.pairs->live();
  DUO_TRY(run.engine_->prepare(setup));
  const double frame_s = input.pairs->frame_s();
  DUO_TRY(run.tracker_->prepare({rig, *run.engine_->rectified(), frame_s, options.engine.threads, input.pairs->live()}));

  run.header_.sources = std::move(input.names);
  run.header_.engine = run.engine_->name();
  run.header_.device = run.engine_->device();
  run.header_.matcher = options.engine.matcher;
  run.header_.matcher_preset = options.engine.preset;
  run.header_.tracker = run.tracker_->name();
  const auto skeletons = run.tracker_->skeletons();
  run.header_.skeletons.assign(skeletons.begin(), skeletons.end());
  run.header_.rectified = *run.engine_->rectified();
  run.header_.size = setup.size;
  run.header_.frame_s = frame_s;
  run.header_.live = input.pairs->live();
  run.frames_ = std::make_unique<FrameAhead>(std::move(input.pairs), *run.engine_, first,
                                             setup.many_at_once ? run.engine_->in_flight() : 1);
  return run;
}

Result<void> ArmRun::set(const std::vector<std::pair<std::string, double>>& parameters) {
  Setup setup = setup_;
  setup.parameters = parameters;
  DUO_TRY(frames_->prepare(setup));
  setup_ = std::move(setup);
  return {};
}

Result<std::span<const Person>> ArmRun::select(std::span<const Selection> selections) {
  Result<std::span<const Person>> people = std::span<const Person>();
  tracker_ms_ = timed([&] { people = tracker_->select(frame(), selections); }).wall_ms;
  return people;
}

std::span<const Person> ArmRun::track() {
  std::span<const Person> people;
  tracker_ms_ = timed([&] { people = tracker_->track(frame()); }).wall_ms;
  return people;
}

TrackedFrame ArmRun::tracked(std::span<const Person> people) const {
  const Pair& pair = frames_->last().pair;
  return {static_cast<std::int64_t>(pair.sequence),
          static_cast<double>(pair.left.t_ns - frames_->start_ns()) * 1e-9,
          pair.left,
          frame(),
          people,
          {}};
}

}  // namespace duo::app
