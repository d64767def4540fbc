// Where tracked persons go: the options of `track` and the boxes of `view`.
#pragma once

#include <string>

#include "command.h"
#include "duoptic/sink_kinds.h"

namespace duo::app {

struct SinkOptions : SinkTargets {
  using SinkTargets::add_to;
  void add_to(CLI::App& app);
  /// Whether the JSON lines go to stdout, as nothing else does; and whether anything does.
  ///
  /// Errors  thrown as usage: two outputs do
  bool lines_on_stdout() const;
  bool on_stdout() const { return lines_on_stdout() || sent_to_stdout() > 0; }
};

/// Each sink that dropped frames: ", 3 dropped by arm.mp4".
std::string dropped_text(const Pipeline& pipeline);

}  // namespace duo::app
