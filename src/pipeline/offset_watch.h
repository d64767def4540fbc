// Two videos of one scene that began at different moments.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "duoptic/frame.h"

namespace duo {

/// Looks for the offset in time at which what moves in two videos fits best: how much moves from picture to picture rises and
/// falls alike in both, at the same moments. Files mostly begin at 0 both and do not tell which camera was started later; depth
/// of what stands still is right then, and of what moves is wrong.
///
/// Threads  one caller
class OffsetWatch {
 public:
  /// How much moves in the pictures of the next pair, in any unit; below `least` it is not much. Of the first half minute.
  void see(TimeNs t_ns, const std::array<double, 2>& motion, double least);
  /// Empty: they fit as they are, or it cannot be told.
  std::string warning() const;

 private:
  TimeNs first_ns_ = 0, last_ns_ = 0;
  double least_ = 0;
  std::array<std::vector<double>, 2> motion_;
};

}  // namespace duo
