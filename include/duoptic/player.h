// A pipeline in a thread of its own, played, paused, sought and recorded as its viewer wishes.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "duoptic/bounded_queue.h"
#include "duoptic/pipeline.h"
#include "duoptic/rig_health.h"
#include "duoptic/sink_kinds.h"
#include "duoptic/skew_watch.h"
#include "duoptic/worker.h"

namespace [[gnu::visibility("default")]] duo {

struct PlayerSetup {
  PipelineSetup pipeline = {};               // with a tracker
  std::function<Result<Input>()> open = {};  // the source: again for each start; must be set
  SinkTargets sinks = {};
  bool loop = false;
  std::function<void()> on_news = [] {};  // called in the player's thread when there is something new to show
  std::function<void(const std::string&)> say = [](const std::string&) {};  // a line of what there is to know
};

/// One instant, for who shows it to keep.
struct Shown {
  std::int64_t number = 0;
  double t_s = 0;
  std::shared_ptr<const Picture> left;  // raw
  std::shared_ptr<const Frame> frame;
  std::vector<Person> people;
  TrackTimes times;
  double skew_ms = 0;      // how much later the right picture was taken
  double latency_ms = 0;   // live: from the picture's capture to here; files: what engine and tracker took
  double interval_ms = 0;  // since the one before; 0: it was not played
};

enum class PlayState : std::uint8_t { kPlaying, kPaused, kEnded };

/// One kind of sink_kinds().
struct OutputStatus {
  std::string name;  // of the file or target, now or last; empty: there was none
  bool on = false;
  std::int64_t frames = 0;
};

struct PlayerStatus {
  PlayState state = PlayState::kPaused;
  bool loop = false;
  bool silent = false;  // live, and no pictures come
  std::int64_t dropped = 0;
  int refused = 0;       // selections, so far
  std::string rig_news;  // what the pairs say is wrong with the rig; empty: nothing
  std::string event;     // live: what cameras and their skew do to the result; empty: nothing
  std::string problem;   // of the last thing tried; empty: none
  std::vector<OutputStatus> outputs;
  bool checking_rig = false;  // scene_health() is at it
  std::optional<Result<SceneHealth>> health;
};

/// Paused at first. Files play at their own rate, or as fast as the engine allows, and leave no frame out; live sources show
/// their newest.
///
/// Threads  any; what is asked for happens between two frames
class Player {
 public:
  /// `pairs`: what setup.open() gave the first time. A setup without tracker or without `open` is a programmer's mistake.
  ///
  /// Errors  those of Pipeline::open() and of the outputs
  static Result<std::unique_ptr<Player>> open(PlayerSetup setup, std::unique_ptr<PairSource> pairs);
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;
  ~Player();

  const TrackHeader& header() const { return pipeline_->header(); }
  const Rig& rig() const { return rig_; }
  /// Of the matcher, by name, as it began; of one name the last counts.
  const std::vector<std::pair<std::string, double>>& parameters() const { return parameters_; }
  bool live() const { return header().live; }
  bool still() const { return still_; }
  bool asks_for_clicks() const { return !pipeline_->tracker()->starts_by_itself(); }
  std::int64_t count() const { return count_; }  // pairs; 0: not known

  std::shared_ptr<const Shown> newest() const;
  PlayerStatus status() const;
  RecordingStatus recording() const { return pipeline_->recording(); }

  void play(bool on);
  void step();
  void restart();
  /// Of files: frame `number`, then as before, playing or paused.
  void seek(std::int64_t number);
  /// Of files: how many times their own rate they play at, at most.
  void set_speed(double factor);
  void loop(bool on);
  /// Tracks from the clicks on the frame shown last; at their frame of a file again each time that it comes by.
  void select(const std::vector<Selection>& selections);
  void forget_people();
  void set(const std::vector<std::pair<std::string, double>>& parameters);
  /// Live, all pairs that the source gives, paused or not; of files those that are read, up to the end. Not of one picture.
  void record(bool on);
  /// Writes or sends tracked frames; `kind` is an index of sink_kinds(). A file gets a name with the date.
  void put_out(std::size_t kind, bool on, const std::string& target);
  /// Looks at the last pair for what the rig is worth; takes a second or so beside the playing.
  void check_rig();

  /// Ends the playing and completes outputs and recording. Call it once. Gives kCut where a file was cut short, else kEnd.
  ///
  /// Errors  what ended the playing before its time; outputs or recordings that could not be written
  Result<Next> finish();
  /// After finish(): why the stream ended before its files did; empty when it did not.
  const std::string& warning() const { return warning_; }

 private:
  explicit Player(PlayerSetup setup) : setup_(std::move(setup)) {}
  void post(std::function<void()> wish) { wishes_.put(wish); }
  Result<void> run(const std::stop_token& stop);
  std::optional<double> due_in_ms() const;
  void advance();
  void at_end(Next end);
  bool reopen(std::int64_t first = 0);
  void show(double interval_ms);
  void write();
  void fail(const Error& error, bool for_good);
  bool resting() const;

  PlayerSetup setup_;
  std::vector<std::pair<std::string, double>> parameters_;
  Rig rig_;
  bool still_ = false;
  std::int64_t count_ = 0;
  std::optional<Pipeline> pipeline_;

  // The thread's own.
  std::optional<std::pair<std::int64_t, std::vector<Selection>>> selected_;  // at which frame
  bool step_ = false;
  double speed_ = 1;
  double next_ms_ = 0, last_ms_ = 0;  // when the next frame is due and when the last came, CLOCK_MONOTONIC
  SkewWatch skew_{1};
  std::string passing_words_;
  double passing_until_ms_ = 0;
  std::optional<Error> failed_;
  bool cut_ = false;
  std::string warning_;

  mutable std::mutex mutex_;  // of what follows
  PlayerStatus status_;
  std::shared_ptr<const Shown> newest_;

  BoundedQueue<std::function<void()>> wishes_{1000, WhenFull::kWait};  // more than anybody clicks between two frames
  Worker checking_, thread_;                                           // last: they use all of the above
};

}  // namespace duo
