#include "matchers/sgm/sgm.h"

#include <algorithm>

namespace duo {

bool looks_clear(const SgmParams& params, int noise_q4, int blur_q4) {
  if (params.clear != 1) return params.clear == 2;
  return noise_q4 == 0 && blur_q4 < kClearBlur_q4;
}

void keep_confidence(View<const std::uint16_t> d_q4, View<std::uint8_t> confidence) {
  for (int y = 0; y < d_q4.height(); ++y) {
    const std::uint16_t* d = d_q4.row(y);
    std::uint8_t* c = confidence.row(y);
    for (int x = 0; x < d_q4.width(); ++x) c[x] = d[x] == Disparity::kNone ? std::uint8_t{0} : std::max(c[x], std::uint8_t{1});
  }
}

}  // namespace duo
