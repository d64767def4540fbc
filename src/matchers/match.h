// What every matcher is told before the first pair, and what it gives for each.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "duoptic/image.h"
#include "matchers/clear_stream.h"

namespace duo {

struct MatchSetup {
  Size size;
  int max_disparity = 0;                                                  // searches [0, max_disparity)
  bool masked = false;                                                    // pairs come with inside pictures
  std::shared_ptr<ClearStream> stream = std::make_shared<ClearStream>();  // shared by all who match pairs of one stream
  std::function<void(double done)> progress = {};                         // of matchers that take seconds; see Setup
  bool denoised = false;  // pairs were smoothed before they were rectified, as raw ones are
};

/// Where the maps go. Confidence, of the matchers that tell it: 1 (doubtful) .. 255 (sure) where there is a disparity, else 0.
/// Filled, of the matchers that know the surfaces around a hole: what the hole would have, or none; anything elsewhere.
///
/// Shape   all as the pair; confidence and filled may be empty = not wanted
struct Match {
  View<std::uint16_t> d_q4;
  View<std::uint8_t> confidence = {};
  View<std::uint16_t> filled = {};
};

/// What a matcher measures of a whole pair before it matches it, or parts of it: by themselves these would be taken otherwise.
struct Measured {
  View<const std::uint8_t> right;  // brought to the left picture's brightness; until the matcher's next pair
  int noise_q4 = 0;
  bool clear = false;
};

}  // namespace duo
