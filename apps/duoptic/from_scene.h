// A rig from any scene, without a board.
#pragma once

#include <optional>
#include <string>

#include "command.h"
#include "input.h"

namespace duo::app {

struct FromSceneOptions {
  std::string left, right;  // pictures or videos; right empty: both views in one file
  InputOptions input;
  std::string intrinsics;            // a rig file whose cameras are used; empty: unknown lenses, not metric
  std::optional<double> baseline_m;  // none: that of the intrinsics' rig
  std::string output;                // the rig file
  int threads = 1;
  bool json = false;
};

/// Declares --intrinsics and --baseline-m.
void add_from_scene_options(CLI::App& app, FromSceneOptions& options);

/// Writes the rig and prints what the scene says of it.
///
/// Errors  those of rig_from_scene(); a rig that the scene itself calls useless is not written
Result<Exit> run_from_scene(const FromSceneOptions& options, const CLI::App& app);

}  // namespace duo::app
