// Pictures that one camera gives again and again while the other's change.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "duoptic/frame.h"

namespace duo {

/// Looks for a camera that hangs, or whose video has each picture twice: what moves is then seen at two moments, and its depth
/// is wrong. A picture counts as repeated when a grid of its pixels is that of the one before, but for what coding it again
/// changes, and the other camera's shows that something moved. One pair costs some thousand comparisons.
///
/// Threads  one caller
class RepeatWatch {
 public:
  void see(const Pair& pair);
  /// How much moved in either picture since the pair before: how many levels the grid's pixels went by, without noise.
  const std::array<double, 2>& motion() const { return motion_; }
  /// That of an arm or a head which moves, in such pictures.
  double least_motion() const;
  /// Live: of a camera that hangs now. Of files: how many pictures were repeated, where they are many. Empty: nothing.
  std::string warning(bool live) const;

 private:
  struct Side {
    std::vector<std::uint8_t> before;  // green of the grid
    int repeated = 0, in_a_row = 0, most_in_a_row = 0;
  };
  std::array<Side, 2> sides_;
  std::array<double, 2> motion_{};
  std::vector<std::uint8_t> now_;
  int moved_ = 0;  // pairs in which a picture shows that something moved
};

}  // namespace duo
