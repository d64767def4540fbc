// Whether a stream's pictures are clear, as its pairs settle it one after the other.
#pragma once

#include <atomic>
#include <cstdint>

#include "stages/types/clear.h"

namespace duo {

/// Shared by all who match pairs of one stream, several at the same time perhaps: what a pair is matched by follows from it and
/// those before it, whoever is first.
///
/// Threads  each pair by one; a pair waits until the one before it has told what it says, which comes early in its matching
class ClearStream {
 public:
  /// Whether the pictures of pair `turn` count as clear; `says`: whether they look it.
  bool next(std::uint64_t turn, bool says) {
    for (std::uint64_t told = told_.load(std::memory_order_acquire); told < turn; told = told_.load(std::memory_order_acquire))
      told_.wait(told, std::memory_order_acquire);
    known_ = next_clear(known_, says);
    const bool clear = known_ > 0;
    told_.store(turn + 1, std::memory_order_release);
    told_.notify_all();
    return clear;
  }

 private:
  int known_ = 0;  // of who has the turn
  std::atomic<std::uint64_t> told_ = 0;
};

}  // namespace duo
