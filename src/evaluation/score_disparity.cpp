#include "duoptic/evaluation.h"

#include <algorithm>
#include <cmath>

namespace duo {
namespace {

BadPercent bad_percent(View<const float> d_px, const StereoScene& scene) {
  const Image<std::uint8_t>* regions[3] = {&scene.regions.nonocc, &scene.regions.all, &scene.regions.disc};
  std::array<std::array<std::int64_t, 3>, 3> bad{};
  std::array<std::int64_t, 3> total{};
  for (int y = 0; y < d_px.height(); ++y)
    for (int x = 0; x < d_px.width(); ++x) {
      const float d = d_px.at(y, x), error = std::abs(d - scene.truth_px.at(y, x));
      for (std::size_t r = 0; r < 3; ++r) {
        if (regions[r]->at(y, x) == 0) continue;
        ++total[r];
        for (std::size_t t = 0; t < 3; ++t) bad[t][r] += d < 0 || error > kBadThresholds_px[t];
      }
    }
  BadPercent out{};
  for (std::size_t t = 0; t < 3; ++t)
    for (std::size_t r = 0; r < 3; ++r)
      out[t][r] = 100.0 * static_cast<double>(bad[t][r]) / static_cast<double>(std::max<std::int64_t>(total[r], 1));
  return out;
}

}  // namespace

Image<float> disparity_as_px(View<const std::uint16_t> d_q4) {
  Image<float> out(d_q4.size());
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      out.at(y, x) = d_q4.at(y, x) == Disparity::kNone ? -1.0f : static_cast<float>(d_q4.at(y, x)) / 16.0f;
  return out;
}

void fill_rows(View<float> d_px) {
  for (int y = 0; y < d_px.height(); ++y) {
    float* row = d_px.row(y);
    for (int x = 0; x < d_px.width();) {
      int end = x;
      while (end < d_px.width() && row[end] < 0) ++end;
      const float left = x > 0 ? row[x - 1] : -1.0f, right = end < d_px.width() ? row[end] : -1.0f;
      std::fill(row + x, row + end, left < 0 || right < 0 ? std::max(left, right) : std::min(left, right));
      x = end + 1;
    }
  }
  // Rows without any: from the nearest row that has some, as matchers leave their border rows empty.
  const int h = d_px.height();
  const auto empty = [&](int y) { return d_px.at(y, 0) < 0; };
  for (int y = 0; y < h; ++y) {
    if (!empty(y)) continue;
    int distance = 1;
    const auto has = [&](int from) { return from >= 0 && from < h && !empty(from); };
    while (distance < h && !has(y - distance) && !has(y + distance)) ++distance;
    const int from = has(y - distance) ? y - distance : y + distance;
    if (has(from)) std::copy_n(d_px.row(from), d_px.width(), d_px.row(y));
  }
}

DisparityScore score_disparity(View<const float> d_px, const StereoScene& scene) {
  DisparityScore out;
  out.bad_holes = bad_percent(d_px, scene);
  Image<float> filled(d_px.size());
  for (int y = 0; y < d_px.height(); ++y) std::copy_n(d_px.row(y), d_px.width(), filled.row(y));
  fill_rows(filled);
  out.bad_filled = bad_percent(filled, scene);

  std::int64_t pixels = 0, covered = 0;
  double error_px = 0;
  for (int y = 0; y < d_px.height(); ++y)
    for (int x = 0; x < d_px.width(); ++x) {
      if (scene.regions.all.at(y, x) == 0) continue;
      ++pixels;
      covered += d_px.at(y, x) >= 0;
      error_px += std::abs(filled.at(y, x) - scene.truth_px.at(y, x));
    }
  out.average_error_px = error_px / static_cast<double>(std::max<std::int64_t>(pixels, 1));
  out.coverage_percent = 100.0 * static_cast<double>(covered) / static_cast<double>(std::max<std::int64_t>(pixels, 1));
  return out;
}

}  // namespace duo
