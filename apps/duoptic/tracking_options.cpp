#include "tracking_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace duo::app {
namespace {

/// As far as `z_m` needs, but no farther than every matcher can search: a large picture starts at a greater depth.
int disparity_at(double z_m, const Rig& rig) {
  constexpr int kMost = 256;
  const double d_px = rig.left.fx_px * rig.baseline_m() / z_m;
  return std::clamp((static_cast<int>(d_px) / 16 + 1) * 16, 16, kMost);
}

}  // namespace

void TrackingOptions::add_to(CLI::App& app) {
  engine.add_to(app);
  app.add_option(
         "--max-disparity", max_disparity,
         fmt::format("Searches disparities of 0 .. N-1 px; without it, down to a distance of {} m, with N of 256 at most",
                     kNearest_m))
      ->type_name("N")
      ->check(CLI::Range(1, Engine::kMaxDisparity));
  app.add_option("--tracker", tracker, "arm: hand, elbow and shoulder, also while they are hidden; thesis: the method of 2010")
      ->check(CLI::IsMember(tracker_names()))
      ->capture_default_str();
}

PipelineSetup TrackingOptions::setup(const Input& input) const {
  PipelineSetup out;
  out.names = input.names;
  out.engine = engine.engine;
  out.threads = engine.threads;
  out.frames = engine.setup();
  out.frames.rig = input.rig;
  out.frames.wants = {.color = all_maps, .views = all_maps, .disparity = all_maps};
  out.frames.many_at_once = in_bulk;
  if (max_disparity > 0)
    out.frames.max_disparity = max_disparity;
  else if (input.rig)
    out.frames.max_disparity = disparity_at(kNearest_m, *input.rig);
  out.tracker = tracker;
  return out;
}

}  // namespace duo::app
