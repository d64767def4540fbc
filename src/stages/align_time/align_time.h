// Motion-compensated temporal alignment: the right picture as it was at the left picture's capture time.
#pragma once

#include <memory>

#include "duoptic/frame.h"

namespace duo::ref {

/// Between the two captures of a pair whose cameras run freely, what moves is matched in the wrong place, or, where it moves up
/// or down, on the wrong rows. Therefore each moving block of the right picture is shifted back by skew / frame time of its
/// motion since the previous right picture; what the block uncovers comes from that previous picture. The other pixels keep
/// their bits.
///
/// Shape    pictures H x W; skew: right capture time - left capture time
/// Reach    28 px per picture at 640x480, in proportion at other sizes; what moves faster stays where it is
/// Exact    integers but for the fraction of the frame time: the same bits on every machine
/// Memory   allocated at the first pair with a skew, from which on every pair is kept for the next, and when the size changes
/// Threads  one caller
/// Source   blocks by exhaustive search (block_flow.h); the compensation is ours
class AlignTime {
 public:
  /// The share that is left, about, of the depth error z v dt / b of what moves with v along the baseline: with it, 95 to 100 %
  /// of the joints of rendered waves, sweeps and reaches lie within three of their sigmas (docs/measurements.md).
  static constexpr double kErrorLeft = 0.25;

  AlignTime();
  ~AlignTime();

  /// The right picture at the left one's capture time, for one pair after the other. Null where nothing is to be done (a skew
  /// below 0.2 ms) or nothing can be (a skew above 150 ms, no right picture in the 150 ms before). Valid until the next call;
  /// its memory may be swapped with that of a picture of the same size.
  Image<Rgb8>* right_of(const Pair& pair);
  /// Takes a pair only as what comes before the next one.
  void remember(const Pair& pair);
  /// True for the first pair with a skew. The pair before it was not kept: right_of() wants begin() with that one before.
  bool begins_with(const Pair& pair) const;
  void begin(const Pair& before);

 private:
  struct State;
  bool see(const Pair& pair);
  void keep(const Pair& pair);
  std::unique_ptr<State> state_;
};

}  // namespace duo::ref
