// A source on its way through engine and tracker, in a thread of its own, as its viewer wishes.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "arm_run.h"
#include "duoptic/rig_health.h"
#include "recording.h"
#include "skew_watch.h"

namespace duo::app::view {

struct PlayerOptions {
  std::string left, right, lines;  // lines: file for JSON lines; empty: none
  std::optional<Rig> rig;
  ArmOptions arm;
  bool loop = false;
  std::function<void()> on_news;  // called in the player's thread when there is something new to show
};

/// One instant, for the window to keep.
struct Shown {
  std::int64_t number = 0;
  double t_s = 0;
  Picture left;  // raw
  Frame frame;   // disparity and colour
  std::vector<Person> people;
  TrackTimes times;
  double skew_ms = 0;      // how much later the right picture was taken
  double latency_ms = 0;   // live: from the picture's capture to here; files: what engine and tracker took
  double interval_ms = 0;  // since the one before; 0: it was not played
};

enum class PlayState : std::uint8_t { kPlaying, kPaused, kEnded };

struct PlayerStatus {
  PlayState state = PlayState::kPaused;
  bool loop = false;
  bool silent = false;  // live, and no pictures come
  std::int64_t dropped = 0, lines = 0;
  int refused = 0;            // selections, so far
  std::string event;          // live: what cameras and their skew do to the result; empty: nothing
  std::string problem;        // of the last thing tried; empty: none
  bool checking_rig = false;  // scene_health() is at it
  std::optional<Result<SceneHealth>> health;
};

/// Paused at first. Files play at their own rate, or as fast as the engine allows, and leave no frame out; live sources show
/// their newest.
///
/// Threads  any; what is asked for happens between two frames
class Player {
 public:
  /// Errors  those of open_input(), ArmRun::open() and make_json_lines()
  static Result<std::unique_ptr<Player>> open(const PlayerOptions& options);
  ~Player();

  const TrackHeader& header() const { return header_; }
  const Rig& rig() const { return rig_; }
  bool live() const { return live_; }
  bool still() const { return still_; }
  bool asks_for_clicks() const { return asks_for_clicks_; }  // the tracker does not start by itself
  std::int64_t count() const { return count_; }              // pairs; 0: not known

  std::shared_ptr<const Shown> newest() const;
  PlayerStatus status() const;
  RecordingStatus recording() const { return recording_.status(); }

  void play(bool on);
  void step();
  void restart();
  void loop(bool on);
  /// Tracks from the clicks on the frame shown last; at their frame of a file again each time that it comes by.
  void select(const std::vector<Selection>& selections);
  void forget_people();
  void set(const std::vector<std::pair<std::string, double>>& parameters);
  /// Live, all pairs that the source gives, paused or not; of files those that are read, up to the end. Not of one picture.
  void record(bool on);
  /// Looks at the last pair for what the rig is worth; takes a second or so beside the playing.
  void check_rig();

  /// Ends the playing and completes lines and recording. Call it once.
  ///
  /// Errors  what ended the playing before its time; lines or recordings that could not be written
  Result<Exit> finish();
  /// After finish(): why the stream ended before its files did; empty when it did not.
  const std::string& warning() const { return warning_; }

 private:
  explicit Player(PlayerOptions options) : options_(std::move(options)) {}
  void post(std::function<void()> wish);
  void run();
  void advance();
  void at_end(Next end);
  bool reopen();
  void keep(std::span<const Person> people) { people_.assign(people.begin(), people.end()); }
  void show(double interval_ms);
  void write_line(TrackedFrame frame);
  void fail(const Error& error, bool for_good);
  bool resting() const;

  PlayerOptions options_;
  TrackHeader header_;
  Rig rig_;
  bool live_ = false, still_ = false, asks_for_clicks_ = true;
  std::int64_t count_ = 0;

  Recording recording_;

  // The thread's own.
  std::optional<ArmRun> run_;
  std::unique_ptr<Sink> lines_;
  std::vector<Person> people_;
  std::optional<std::pair<std::int64_t, std::vector<Selection>>> selected_;  // at which frame
  std::int64_t passed_ = 0;                                                  // frames of earlier rounds of a loop
  double passed_s_ = 0;
  bool has_frame_ = false, step_ = false;
  double next_ms_ = 0, last_ms_ = 0;  // when the next frame is due and when the last came, CLOCK_MONOTONIC
  std::int64_t written_ = 0;
  SkewWatch skew_{1};
  std::string passing_words_;
  double passing_until_ms_ = 0;
  std::optional<Error> failed_;
  bool cut_ = false;
  std::string warning_;

  mutable std::mutex mutex_;  // of what follows
  std::condition_variable wished_;
  std::vector<std::function<void()>> wishes_;
  bool stopped_ = false;
  PlayerStatus status_;
  std::shared_ptr<const Shown> newest_;
  std::future<void> checking_;  // last, with the thread: they use all of the above
  std::thread thread_;
};

}  // namespace duo::app::view
