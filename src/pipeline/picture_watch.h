// What is wrong with the pictures of a run, whatever their rig.
#pragma once

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
  void see(const Pair& pair);
  /// In one line; empty: nothing.
  std::string warning(bool live) const;

 private:
  RepeatWatch repeats_;
  OffsetWatch offset_;
  std::optional<std::string> bars_;  // by the first pair
};

}  // namespace duo
