#include "matchers/sgm/sgm.h"

#include <algorithm>
#include <cstdlib>

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

MatchPlanes each_row(MatchPlanes planes, int step) {
  const auto thin = [&](auto& all) {
    for (auto& plane : all) plane = each_row(plane, step);
  };
  thin(planes.census), thin(planes.value), thin(planes.low), thin(planes.high);
  planes.outside = each_row(planes.outside, step);
  return planes;
}

void fill_between(View<const std::uint8_t> gray, int step, int y, const Match& out) {
  constexpr int kSameSurface_q4 = 16;
  const int w = out.d_q4.width(), before = y / step * step, after = before + step, above = y - before, below = after - y;
  const bool tells = !out.confidence.empty();
  std::uint16_t* const d = out.d_q4.row(y);
  if (after >= out.d_q4.height()) {
    std::copy_n(out.d_q4.row(before), w, d);
    if (tells) std::copy_n(out.confidence.row(before), w, out.confidence.row(y));
    return;
  }
  const std::uint16_t *const d0 = out.d_q4.row(before), *const d1 = out.d_q4.row(after);
  const std::uint8_t *const g0 = gray.row(before), *const g1 = gray.row(after), *const g = gray.row(y);
  const auto upper_is_closer = [&](int x) { return std::abs(g[x] - g0[x]) <= std::abs(g[x] - g1[x]); };
  // Two holes are equal, and so is their mean; one differs from every disparity by more than a surface does.
  const auto one_surface = [&](int x) { return std::abs(d0[x] - d1[x]) <= kSameSurface_q4; };
  for (int x = 0; x < w; ++x) {
    const int mean = (d0[x] * below + d1[x] * above + step / 2) / step;
    d[x] = one_surface(x) ? static_cast<std::uint16_t>(mean) : upper_is_closer(x) ? d0[x] : d1[x];
  }
  if (!tells) return;
  const std::uint8_t *const c0 = out.confidence.row(before), *const c1 = out.confidence.row(after);
  std::uint8_t* const c = out.confidence.row(y);
  for (int x = 0; x < w; ++x) c[x] = one_surface(x) ? std::min(c0[x], c1[x]) : upper_is_closer(x) ? c0[x] : c1[x];
}

}  // namespace duo
