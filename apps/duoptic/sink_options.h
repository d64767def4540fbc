// The options that say where tracked persons go.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "command.h"
#include "duoptic/sink.h"

namespace duo::app {

/// A sink and how its user knows it.
struct NamedSink {
  std::string name;
  std::unique_ptr<Sink> sink;
};

struct SinkOptions {
  std::string lines, video;
  std::vector<std::string> csv, bvh, osc, vmc;
  std::string axes = "opencv";

  void add_to(CLI::App& app);
  /// All that were asked for; JSON lines last, on stdout without -o. `live`: none of them can slow the others or the tracker.
  ///
  /// Errors  those of the sinks; a sink made before leaves nothing
  Result<std::vector<NamedSink>> make(const TrackHeader& header, bool live, const CLI::App& app) const;
};

/// Each sink that dropped frames: ", 3 dropped by arm.mp4".
std::string dropped_text(const std::vector<NamedSink>& sinks);

}  // namespace duo::app
