// The options of what tracks: `track`, `eval clip` and `view`.
#pragma once

#include <string>

#include "command.h"
#include "duoptic/pipeline.h"
#include "input.h"

namespace duo::app {

struct TrackingOptions {
  EngineOptions engine;
  std::string tracker;                 // empty: the command's own
  BodyModel model = BodyModel::kFull;  // of a tracker with networks
  int max_disparity = 0;               // 0: disparities_for_people()
  PeopleFocus focus = PeopleFocus::kOff;
  bool hands = false;     // fingers, too: the tracker body_hands for body
  bool all_maps = false;  // frames are drawn or scored, not only tracked
  bool in_bulk = false;   // of files: as many frames per second as can be, rather than each soon

  void add_to(CLI::App& app);
  /// With a tracker where none was chosen, and its fingers where they are wanted. Throws CLI::ValidationError where the
  /// tracker has none.
  TrackingOptions or_tracker(const char* name) const;
  /// Errors  those of every rig
  Result<PipelineSetup> setup(const Input& input) const;
};

}  // namespace duo::app
