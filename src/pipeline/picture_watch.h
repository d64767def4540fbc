// What is wrong with the pictures of a run, whatever their rig.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "duoptic/frame.h"
#include "pipeline/offset_watch.h"
#include "pipeline/repeat_watch.h"

namespace duo {

/// Cameras that hang, and of files whether they did not begin together and have black bars.
///
/// Threads  one caller
class PictureWatch {
 public:
  void see(const Pair& pair, bool live);
  /// In one line; empty: nothing.
  std::string warning(bool live) const;

 private:
  RepeatWatch repeats_;
  OffsetWatch offset_;
  std::uint64_t seen_ = 0;
  std::optional<std::string> bars_;  // of all pairs that were looked at; none: nothing but dark ones
};

}  // namespace duo
