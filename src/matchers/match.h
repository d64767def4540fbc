// What every matcher is told before the first pair, and what it gives for each.
#pragma once

#include <cstdint>

#include "duoptic/image.h"

namespace duo {

struct MatchSetup {
  Size size;
  int max_disparity = 0;  // searches [0, max_disparity)
  bool masked = false;    // pairs come with inside pictures
};

/// Where the maps go. Confidence, of the matchers that tell it: 1 (doubtful) .. 255 (sure) where there is a disparity, else 0.
///
/// Shape   both as the pair; confidence may be empty = not wanted
struct Match {
  View<std::uint16_t> d_q4;
  View<std::uint8_t> confidence = {};
};

}  // namespace duo
