#include "tracking_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "duoptic/calibrate.h"

namespace duo::app {
void TrackingOptions::add_to(CLI::App& app) {
  engine.add_to(app);
  app.add_option(
         "--max-disparity", max_disparity,
         fmt::format("Searches disparities of 0 .. N-1 px; without it, down to a distance of {} m, with N of {} at most",
                     kNearest_m, kMostDisparities))
      ->type_name("N")
      ->check(CLI::Range(1, Engine::kMaxDisparity));
  app.add_option("--tracker", tracker, "arm: hand, elbow and shoulder, also while they are hidden; thesis: the method of 2010")
      ->check(CLI::IsMember(tracker_names()))
      ->capture_default_str();
}

Result<PipelineSetup> TrackingOptions::setup(const Input& input) const {
  PipelineSetup out;
  out.names = input.names;
  out.engine = engine.engine;
  out.threads = engine.threads;
  out.frames = engine.setup();
  out.frames.rig = input.rig;
  out.frames.wants = {.color = all_maps, .views = all_maps, .disparity = all_maps};
  out.frames.many_at_once = in_bulk;
  if (max_disparity > 0) {
    out.frames.max_disparity = max_disparity;
  } else if (input.rig) {
    DUO_TRY_ASSIGN(const int from_nearest, disparities_from(*input.rig, kNearest_m));
    out.frames.max_disparity = std::min(from_nearest, kMostDisparities);
  }
  out.tracker = tracker;
  return out;
}

}  // namespace duo::app
