// Cameras, or files, that are looked at until they have a rig: the guide of a calibration in a thread of its own.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "duoptic/bounded_queue.h"
#include "duoptic/calibration_guide.h"
#include "duoptic/picture_figures.h"
#include "duoptic/source.h"
#include "duoptic/worker.h"

namespace [[gnu::visibility("default")]] duo {

struct CalibrationSessionSetup {
  std::string left_name, right_name;  // of the cameras, in the rig
  // The source again: a file is read from its start. Empty: of files no other board can be chosen.
  std::function<Result<std::unique_ptr<PairSource>>()> open = {};
  std::function<void()> on_news = [] {};  // called in the thread when there is something new to show; may be empty
};

enum class SessionState : std::uint8_t { kLooking, kSolving, kSolved, kEnded };

struct SessionStatus {
  SessionState state = SessionState::kLooking;
  std::shared_ptr<const Pair> pair;  // the last that was looked at
  GuideLook look;                    // at it
  BoardWishes met{};
  int views = 0;
  std::array<Coverage, 2> covered{};  // of each camera
  std::array<PictureFigures, 2> figures{};
  std::array<double, 2> best_focus{};
  std::int64_t looked = 0, count = 0;  // pairs of a file, so far and in all; count 0: not known
  bool silent = false;                 // live, and no pictures come
  std::string problem;                 // of the last thing tried; empty: none
  std::shared_ptr<const Calibration> found;
};

/// Live pairs are looked at as they come; of files one every tenth of a second of their time, as fast as that goes. Calibrates
/// by itself when the guide has enough, and at the end of a file.
///
/// Threads  any
class CalibrationSession {
 public:
  /// Errors  the system gives no thread
  static Result<std::unique_ptr<CalibrationSession>> start(CalibrationSessionSetup setup, std::unique_ptr<PairSource> pairs,
                                                           const Board& board);
  ~CalibrationSession();
  CalibrationSession(const CalibrationSession&) = delete;
  CalibrationSession& operator=(const CalibrationSession&) = delete;

  SessionStatus status() const;
  bool live() const { return live_; }
  Board board() const;

  /// Another board, from the beginning.
  void choose(const Board& board);
  /// The views that were taken stay.
  void set_square_m(double square_m);
  /// The board that the last pair shows becomes the one that is looked for.
  void recognise();
  /// From what there is.
  void solve();
  /// After a result: more views; the result is dropped. At the end of a file there are none, and it stays.
  void go_on();
  /// Writes the rig that was found, and its report beside it.
  ///
  /// Errors  there is none; a file of that name is there; those of save_rig() and write_calibration_report()
  Result<void> save(const std::string& file) const;

 private:
  CalibrationSession(CalibrationSessionSetup setup, std::unique_ptr<PairSource> pairs, const Board& board);
  void post(std::function<void()> wish) { wishes_.put(wish); }
  Result<void> run(const std::stop_token& stop);
  void advance();
  void look();
  void begin(const Board& board);
  void find_rig();
  void say(const std::string& problem);
  bool looking() const;

  const CalibrationSessionSetup setup_;
  const bool live_;

  // The thread's own.
  std::unique_ptr<PairSource> pairs_;
  std::shared_ptr<Pair> pair_;
  TimeNs looked_ns_ = 0;
  bool ended_ = false;

  mutable std::mutex mutex_;  // of what follows
  SessionStatus status_;
  CalibrationGuide guide_;  // changed by the thread alone

  BoundedQueue<std::function<void()>> wishes_{1000, WhenFull::kWait};
  Worker thread_;  // last: it uses all of the above
};

}  // namespace duo
