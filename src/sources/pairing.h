// Which left picture belongs to which right one: the one rule of live sources and of files.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "duoptic/frame.h"

namespace duo {

enum class CameraSide : std::uint8_t { kLeft, kRight };

/// Pairs each picture with the nearest of the other camera in time, when that lies within half the time from one picture of the
/// faster camera to its next. That time is measured, as the median of the last ones: cameras change their rates. Each picture
/// is used once.
///
/// Where a later picture waits already, as in files, and is nearer by a quarter of that time, the earlier one stays alone. Two
/// cameras that run half a picture apart keep their partners, although their times jitter.
///
/// Threads  one caller at a time
class Pairing {
 public:
  enum class Step : std::uint8_t {
    kPair,   // one more
    kAlone,  // a picture was left out: it has no partner
    kMore,   // nothing can be said before more pictures come
  };

  /// Seconds from picture to picture of both cameras, left first, until they are measured.
  explicit Pairing(std::array<double, 2> frame_s);

  /// Takes the picture's content and gives memory to fill again in exchange. Times of one camera rise.
  void put(CameraSide side, Picture& picture);
  /// The pixels of the picture number `i` of those that wait, which was put by its time alone; gives memory in exchange. False
  /// where the times differ.
  bool complete(CameraSide side, std::size_t i, Picture& picture);
  /// One decision on the pictures that wait. Only a pair changes `into`.
  Step step(Pair& into);

  std::size_t waiting(CameraSide side) const { return cameras_[index(side)].waiting.size(); }
  std::int64_t put_so_far(CameraSide side) const { return cameras_[index(side)].put; }
  std::int64_t alone(CameraSide side) const { return cameras_[index(side)].alone; }

 private:
  struct Camera {
    std::deque<Picture> waiting;
    double frame_ns = 0;
    std::array<TimeNs, 9> steps_ns{};  // the last ones
    TimeNs last_ns = 0;
    std::int64_t put = 0, alone = 0;
  };
  static std::size_t index(CameraSide side) { return static_cast<std::size_t>(side); }
  Step leave_out(Camera& camera);
  void release(Picture&& picture) { free_.push_back(std::move(picture)); }

  std::array<Camera, 2> cameras_;
  std::vector<Picture> free_;
  std::uint64_t made_ = 0;  // pairs
  double last_skew_ns_ = 0;
};

}  // namespace duo
