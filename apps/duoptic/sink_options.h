// Where tracked persons go: the options of `track` and the boxes of `view`.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "command.h"
#include "duoptic/pipeline.h"
#include "duoptic/stdout.h"

namespace duo::app {

struct SinkOptions;

/// One kind of output.
struct SinkKind {
  const char *option, *type, *help;
  const char* label;   // in the window
  const char* target;  // in the window: the ending of a file's name, or host:port
  /// `note`: what its user should know of it; else as it was.
  Result<std::unique_ptr<Sink>> (*make)(const std::string& target, const SinkOptions& options, const TrackHeader& header,
                                        std::string& note);
  bool is_file() const { return *target == '.'; }
};
/// JSON lines are the first.
std::span<const SinkKind> sink_kinds();

struct SinkOptions {
  std::vector<std::vector<std::string>> targets;  // of each kind
  std::string axes = "opencv";
  VmcBones vmc_bones = VmcBones::kWhole;

  SinkOptions() : targets(sink_kinds().size()) {}
  void add_to(CLI::App& app);
  /// An output draws or writes maps, so that frames must have them.
  bool wants_maps() const;
  /// An output holds the depth of the whole picture.
  bool writes_depth() const;
  /// Whether an output goes to stdout: the JSON lines where nothing else is sent there.
  ///
  /// Errors  thrown as usage: two outputs do
  bool on_stdout() const;
  bool lines_on_stdout() const;
  /// One more output of a running pipeline, called `target`.
  ///
  /// Returns  what its user should know of it, or ""
  /// Errors   those of the kind
  Result<std::string> add_sink(Pipeline& pipeline, const SinkKind& kind, const std::string& target) const;
  /// Every output that was asked for.
  ///
  /// Errors  those of the kinds; an output made before leaves nothing
  Result<void> add_sinks(Pipeline& pipeline, const CLI::App& app) const;

 private:
  std::ptrdiff_t sent_to_stdout() const;
};

/// Each sink that dropped frames: ", 3 dropped by arm.mp4".
std::string dropped_text(const Pipeline& pipeline);

}  // namespace duo::app
