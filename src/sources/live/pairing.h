// Which left picture belongs to which right one.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "duoptic/frame.h"

namespace duo {

enum class CameraSide : std::uint8_t { kLeft, kRight };

/// Takes the pictures of two cameras as they come and pairs each with the nearest of the other, when that lies within half a
/// frame: a nearer one cannot follow. Each picture is used once.
///
/// Threads  one caller at a time
class Pairing {
 public:
  /// `frame_s`: of the faster camera.
  explicit Pairing(double frame_s);

  /// Takes the picture's content and gives memory to fill again in exchange. Whether it completes a pair, which is then in
  /// `into`.
  bool add(CameraSide side, Picture& picture, Pair& into);

  std::int64_t lonely() const { return lonely_; }  // pictures without a partner

 private:
  bool match(Pair& into);
  void release(Picture&& picture) { free_.push_back(std::move(picture)); }

  TimeNs limit_ns_;
  std::array<std::deque<Picture>, 2> waiting_;
  std::vector<Picture> free_;
  std::uint64_t made_ = 0;  // pairs
  std::int64_t lonely_ = 0;
};

}  // namespace duo
