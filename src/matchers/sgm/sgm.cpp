#include "matchers/sgm/sgm.h"

#include <algorithm>

namespace duo {

bool looks_clear(const SgmParams& params, int noise_q4, int blur_q4) {
  if (params.clear != 1) return params.clear == 2;
  return noise_q4 == 0 && blur_q4 < kClearBlur_q4;
}

bool refines(const SgmParams& params, bool masked) { return params.refine == 2 || (params.refine == 1 && masked); }

bool is_even(const SgmParams& params, bool denoised) { return params.even == 2 || (params.even == 1 && denoised); }

void keep_confidence(View<const std::uint16_t> d_q4, int y, View<std::uint16_t> columns, View<std::uint8_t> confidence) {
  const int w = d_q4.width(), h = d_q4.height();
  std::uint16_t* const least = columns.row(0);
  std::uint16_t* const above_most = columns.row(1);  // one more than the most, so that holes are 0
  std::fill_n(least, w, Disparity::kNone);
  std::fill_n(above_most, w, std::uint16_t{0});
  for (int v = std::max(y - kConfidenceReach, 0); v <= std::min(y + kConfidenceReach, h - 1); ++v) {
    const std::uint16_t* const d = d_q4.row(v);
    for (int x = 0; x < w; ++x) {
      least[x] = std::min(least[x], d[x]);
      above_most[x] = std::max(above_most[x], static_cast<std::uint16_t>(d[x] + 1));
    }
  }
  for (int x = 0; x < w; ++x) {
    std::uint8_t& c = confidence.at(y, x);
    if (d_q4.at(y, x) == Disparity::kNone) {
      c = 0;
      continue;
    }
    const int first = std::max(x - kConfidenceReach, 0), end = std::min(x + kConfidenceReach + 1, w);
    const int step =
        *std::max_element(above_most + first, above_most + end) - 1 - *std::min_element(least + first, least + end);
    c = static_cast<std::uint8_t>(confidence_of(c, step));
  }
}

}  // namespace duo
