// What persons can be written as or sent to: a table of all kinds of sinks, and the sinks of a run by it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "duoptic/axes.h"
#include "duoptic/pipeline.h"
#include "duoptic/result.h"
#include "duoptic/sink.h"

namespace [[gnu::visibility("default")]] duo {

struct SinkTargets;

/// What an output needs of frames beside people.
enum class SinkMaps : std::uint8_t { kNone, kDrawn, kDepth };

/// One kind of output.
struct SinkKind {
  const char *option, *type, *help;  // on the command line
  const char* label;                 // in a window
  const char* target;                // the ending of a file's name, or host:port
  bool once;                         // in a run
  SinkMaps maps;
  /// `note`: what its user should know of it; else as it was.
  Result<std::unique_ptr<Sink>> (*make)(const std::string& target, const SinkTargets& how, const TrackHeader& header,
                                        std::string& note);
  bool is_file() const { return *target == '.'; }
};
/// JSON lines are the first.
std::span<const SinkKind> sink_kinds();

/// The outputs of a run.
struct SinkTargets {
  std::vector<std::vector<std::string>> targets;  // of each kind: files, or host:port
  Axes axes = Axes::kOpencv;                      // of CSV and OSC
  VmcBones vmc_bones = VmcBones::kWhole;

  SinkTargets() : targets(sink_kinds().size()) {}
  /// An output draws or writes maps, so that frames must have them.
  bool wants_maps() const;
  /// An output holds the depth of the whole picture.
  bool writes_depth() const;
  /// How many outputs go to stdout.
  std::ptrdiff_t sent_to_stdout() const;
  /// One more output of a running pipeline, called `target`; empty: stdout.
  ///
  /// Returns  what its user should know of it, or ""
  /// Errors   those of the kind
  Result<std::string> add_to(Pipeline& pipeline, const SinkKind& kind, const std::string& target) const;
  /// All of them. JSON lines last: they may go to stdout, where they must not begin before all else could be opened.
  ///
  /// Returns  what its user should know of them, a line each
  /// Errors   those of the kinds; an output made before leaves nothing
  Result<std::vector<std::string>> add_all_to(Pipeline& pipeline) const;
};

}  // namespace duo
