// Pairs of cameras that run freely, put to one moment before they are matched.
#pragma once

#include <memory>

#include "duoptic/frame.h"

namespace duo {

/// What moved between the two pictures of a pair would be matched in the wrong place, or, when it moved up or down, on the
/// wrong rows. So it is moved in the right picture to where it was when the left one was taken: along the way that its blocks
/// came since the right camera's last picture, by the skew's share of the time since then. What it covered is taken from that
/// last picture. The rest keeps its bits.
///
/// Exact    integers but for the share: the same bits on every machine; a pair whose skew is below 0.2 ms is left alone
/// Reach    28 px a picture at 640x480, in proportion at other sizes; what goes faster is left where it is
/// Memory   allocated at the first pair with a skew, and when the size changes
/// Threads  one caller
class InStep {
 public:
  InStep();
  ~InStep();
  /// The right picture at the left one's moment, for one pair after the other; valid until the next call, and may be swapped
  /// with the pair's. Null where there is nothing to do (no skew to speak of) or nothing to do it with (no picture shortly before).
  Image<Rgb8>* right_of(const Pair& pair);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace duo
