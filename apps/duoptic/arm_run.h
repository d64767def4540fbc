// A clip on its way through engine and tracker: what `track` and `eval clip` share.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "command.h"
#include "duoptic/sink.h"
#include "duoptic/source.h"
#include "duoptic/tracker.h"
#include "read_ahead.h"

namespace duo::app {

struct ArmOptions {
  EngineOptions engine;
  std::string tracker_preset = "default";
  int max_disparity = 0;  // 0: what something at kNearest_m has

  void add_to(CLI::App& app);
};

/// Reads pairs, and makes frames and arms of them; read(), then to_frame(), then select() or track().
class ArmRun {
 public:
  static constexpr double kNearest_m = 0.5;

  /// Errors  those of open_pairs(), Engine::prepare() and Tracker::prepare()
  static Result<ArmRun> open(const std::string& left, const std::string& right, const Rig& rig, const ArmOptions& options);

  /// Takes the next pair from the files.
  Result<Next> read();
  const Frame& to_frame();
  Result<void> select(const std::vector<ArmSelection>& arms) { return tracker_->select(*frame_, arms); }
  const std::vector<ArmPose>& track();

  const ReadAhead& pairs() const { return *pairs_; }
  const Recording& recording() const { return recording_; }
  /// The last pair and its frame, as sinks take them.
  TrackedFrame tracked(const std::vector<ArmPose>& arms) const;
  TrackTimes times() const { return times_; }  // of the last frame

 private:
  ArmRun() = default;
  std::unique_ptr<ReadAhead> pairs_;
  std::unique_ptr<Engine> engine_;
  std::unique_ptr<Tracker> tracker_;
  Recording recording_;
  Pair pair_;
  const Frame* frame_ = nullptr;
  TimeNs start_ns_ = 0;
  TrackTimes times_;
};

}  // namespace duo::app
