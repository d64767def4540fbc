// A clip on its way through engine and tracker: what `track` and `eval clip` share.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "duoptic/sink.h"
#include "duoptic/source.h"
#include "duoptic/tracker.h"
#include "frame_ahead.h"
#include "input.h"

namespace duo::app {

struct ArmOptions {
  EngineOptions engine;
  std::string tracker = "arm";
  int max_disparity = 0;  // 0: what something at kNearest_m has
  bool all_maps = false;  // frames are drawn or scored, not only tracked
  bool in_bulk = false;   // of files: as many frames a second as can be, rather than each soon; not for set()

  void add_to(CLI::App& app);
};

/// Pairs, frames and persons of a clip: next(), then select() or track(). The next frame is made while this one is tracked.
class ArmRun {
 public:
  static constexpr double kNearest_m = 0.5;

  /// Pairs before number `first` are passed over.
  /// Errors  no rig; those of Engine::prepare() and Tracker::prepare()
  static Result<ArmRun> open(Input input, const ArmOptions& options, std::int64_t first = 0);

  Result<Next> next() { return frames_->next(); }
  const Frame& frame() const { return *frames_->last().frame; }
  /// As Tracker::select() and track(): select() has looked at the frame.
  Result<std::span<const Person>> select(std::span<const Selection> selections);
  std::span<const Person> track();
  void reset() { tracker_->reset(); }

  /// Other parameters of the matcher, by name; the last frame is made anew, tracking goes on.
  Result<void> set(const std::vector<std::pair<std::string, double>>& parameters);

  const Rig& rig() const { return *setup_.rig; }
  const Tracker& tracker() const { return *tracker_; }
  FrameAhead& frames() const { return *frames_; }
  const TrackHeader& header() const { return header_; }
  /// The last pair and its frame, as sinks take them.
  TrackedFrame tracked(std::span<const Person> people) const;
  TrackTimes times() const { return {frames_->last().engine_ms, tracker_ms_}; }  // of the last frame

 private:
  ArmRun() = default;
  Setup setup_;
  std::unique_ptr<Engine> engine_;
  std::unique_ptr<FrameAhead> frames_;  // after the engine, which it uses to its end
  std::unique_ptr<Tracker> tracker_;
  TrackHeader header_;
  double tracker_ms_ = 0;
};

}  // namespace duo::app
