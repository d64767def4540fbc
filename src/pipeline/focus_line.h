// Where the next pairs are matched: around the people of frames before.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>

#include "duoptic/engine.h"
#include "duoptic/frame.h"
#include "duoptic/person.h"
#include "duoptic/rig.h"

namespace duo {

/// The box around people: each joint where it is and where its velocity takes it in `ahead_s`, and 25 cm around both, half a
/// body's depth and what a hand that turns back gains in a tenth of a second. Between all disparities: without those of what is
/// behind or before people, or of what matches nothing, plain walls take theirs. Every second row, where each of the people has 500 rows a metre.
/// Empty, which is all, where nobody is.
Focus around(std::span<const Person> people, const Rectified& rectified, double ahead_s);

/// Of files, pair n is matched around the people of frame n - kBehind, whatever the threads; of a live source around those of
/// the newest frame. Every kWholeEvery-th pair is matched as a whole, from number kFirstWhole on, since people who come in are
/// found there; every kMissedEvery-th while nothing is seen of somebody, who may come back anywhere.
///
/// Threads  one that tells, one that asks, and any that closes
class FocusLine {
 public:
  static constexpr int kBehind = 4;  // while a frame is tracked two are made, and one may wait for the tracker
  static constexpr int kWholeEvery = 16, kMissedEvery = 4, kFirstWhole = 4;
  FocusLine(const Rectified& rectified, double frame_s, bool live)
      : rectified_(rectified), ahead_s_(kBehind * frame_s), live_(live) {}

  /// The people of the next frame, and its time: where frames come at longer intervals, people get farther.
  void tell(std::span<const Person> people, TimeNs t_ns);
  /// For the next pair; waits for the frame that it depends on.
  Focus next();
  /// The people are forgotten: the first pair that can know of it is matched as a whole.
  void forget();
  /// Lets next() return.
  void close();

 private:
  const Rectified rectified_;
  const double ahead_s_;
  const bool live_;
  std::mutex mutex_;  // of what follows
  std::condition_variable news_;
  struct Told {
    Focus focus;
    bool missed = false;  // somebody
  };
  std::array<Told, kBehind + 1> ring_;
  std::int64_t told_ = 0, asked_ = 0, whole_pair_ = -1;  // whole_pair_: a pair that is matched as a whole
  bool closed_ = false;
  std::optional<TimeNs> last_ns_;  // of who tells
};

}  // namespace duo
