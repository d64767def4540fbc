#include "tracking_options.h"

#include <fmt/format.h>

#include <utility>

#include "duoptic/calibrate.h"

namespace duo::app {
void TrackingOptions::add_to(CLI::App& app) {
  engine.add_to(app);
  app.add_option(
         "--max-disparity", max_disparity,
         fmt::format("Searches disparities of 0 .. N-1 px; without it, down to a distance of {} m, with N of {} at most",
                     kNearestPeople_m, kMostPeopleDisparities))
      ->type_name("N")
      ->check(within(1, Engine::kMaxDisparity));
  app.add_option(
         "--tracker", tracker,
         "body: whole people, without clicks; body_hands: the same with their fingers; arm: hand, elbow and shoulder that are\n"
         "clicked, also while they are hidden; thesis: the method of 2010")
      ->check(CLI::IsMember(tracker_names()));
  add_choice_option(app, "--model", model, kBodyModelNames,
                    "The network of bodies of the tracker body: lite, full or heavy (see duoptic detect)");
  app.add_flag(
      "--hands", hands,
      "Fingers, too: 20 joints more of each hand, and how far the tips of thumb and index finger are apart. Looks for\n"
      "both hands in every frame, not in turn");
  app.add_flag_callback(
      "--focus", [this] { focus = PeopleFocus::kOn; },
      "Match around people alone, and every 16th frame as a whole, every fourth while nothing is seen of somebody: a seventh\n"
      "to a quarter of the CPU time less, joints like those of whole frames but not to the bit. Of the tracker body; the CPU\n"
      "makes the frames. What track does by itself where the CPU makes the frames and no output holds depth");
}

TrackingOptions TrackingOptions::or_tracker(const char* name) const {
  TrackingOptions out = *this;
  if (out.tracker.empty()) out.tracker = name;
  if (hands && out.tracker == "body") out.tracker = "body_hands";
  if (hands && out.tracker != "body_hands")
    throw CLI::ValidationError("--hands",
                               fmt::format("the tracker {} has no fingers; leave out --hands, or take the tracker body "
                                           "without --select",
                                           out.tracker));
  return out;
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
    DUO_TRY_ASSIGN(out.frames.max_disparity, disparities_for_people(*input.rig));
  }
  out.tracker = tracker;
  out.focus = focus;
  out.body_model = model;
  return out;
}

}  // namespace duo::app
