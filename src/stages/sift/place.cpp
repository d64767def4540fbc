// What is done once a point: refinement, peaks of the orientation histogram, the descriptor's bytes. Both engines use it.

#include <algorithm>
#include <cmath>

#include "stages/sift/kernels.h"

namespace duo::sift {
namespace {

/// First and second derivatives of the differences along x, y and level at a pixel.
struct Derivatives {
  float value, dx, dy, ds, dxx, dyy, dss, dxy, dxs, dys;

  Derivatives(const View<const float>* differences, const Pixel& at) {
    const auto v = [&](int s, int y, int x) { return differences[at.level + s].at(at.y + y, at.x + x); };
    value = v(0, 0, 0);
    dx = (v(0, 0, 1) - v(0, 0, -1)) * 0.5f;
    dy = (v(0, 1, 0) - v(0, -1, 0)) * 0.5f;
    ds = (v(1, 0, 0) - v(-1, 0, 0)) * 0.5f;
    dxx = v(0, 0, 1) + v(0, 0, -1) - 2 * value;
    dyy = v(0, 1, 0) + v(0, -1, 0) - 2 * value;
    dss = v(1, 0, 0) + v(-1, 0, 0) - 2 * value;
    dxy = (v(0, 1, 1) - v(0, 1, -1) - v(0, -1, 1) + v(0, -1, -1)) * 0.25f;
    dxs = (v(1, 0, 1) - v(1, 0, -1) - v(-1, 0, 1) + v(-1, 0, -1)) * 0.25f;
    dys = (v(1, 1, 0) - v(1, -1, 0) - v(-1, 1, 0) + v(-1, -1, 0)) * 0.25f;
  }

  /// Offset to the extremum of the quadratic, by Cramer's rule; false when there is none.
  bool offset(float& x, float& y, float& s) const {
    const double xx = dxx, yy = dyy, ss = dss, xy = dxy, xs = dxs, ys = dys;
    const double a = yy * ss - ys * ys, b = xs * ys - xy * ss, c = xy * ys - xs * yy;
    const double determinant = xx * a + xy * b + xs * c;
    if (std::abs(determinant) < 1e-9) return false;
    const double d = xx * ss - xs * xs, e = xs * xy - xx * ys, f = xx * yy - xy * xy;
    x = static_cast<float>(-(a * dx + b * dy + c * ds) / determinant);
    y = static_cast<float>(-(b * dx + d * dy + e * ds) / determinant);
    s = static_cast<float>(-(c * dx + e * dy + f * ds) / determinant);
    return true;
  }

  bool on_edge(float ratio) const {
    const float trace = dxx + dyy, determinant = dxx * dyy - dxy * dxy;
    return determinant <= 0 || trace * trace * ratio >= (ratio + 1) * (ratio + 1) * determinant;
  }
};

}  // namespace

bool refine(const View<const float> (&differences)[SiftScratch::kLevels + 2], const SiftParams& params, Pixel& at,
            SiftScratch::Place& place) {
  constexpr int kSteps = 5;
  const Size size = differences[0].size();
  for (int step = 0; step < kSteps; ++step) {
    const Derivatives d(differences, at);
    float x, y, s;
    if (!d.offset(x, y, s)) return false;
    if (std::abs(x) < 0.5f && std::abs(y) < 0.5f && std::abs(s) < 0.5f) {
      const float contrast = std::abs(d.value + 0.5f * (d.dx * x + d.dy * y + d.ds * s)) / 255;
      if (contrast * SiftScratch::kLevels < params.contrast || d.on_edge(params.edge)) return false;
      place.x = static_cast<float>(at.x) + x;
      place.y = static_cast<float>(at.y) + y;
      place.scale = static_cast<float>(at.level) + s;
      place.response = contrast;
      place.level = static_cast<std::uint8_t>(at.level);
      return true;
    }
    const float reach = static_cast<float>(size.width + size.height);
    if (std::abs(x) > reach || std::abs(y) > reach || std::abs(s) > reach) return false;
    at.x += static_cast<int>(std::lround(x));
    at.y += static_cast<int>(std::lround(y));
    at.level += static_cast<int>(std::lround(s));
    if (at.level < 1 || at.level > SiftScratch::kLevels || at.x < kBorder || at.x >= size.width - kBorder || at.y < kBorder ||
        at.y >= size.height - kBorder)
      return false;
  }
  return false;
}

void find_angles(const std::int32_t* histogram, SiftScratch::Place& place) {
  std::int64_t smooth[kDirections];
  const auto at = [&](int i) { return std::int64_t{histogram[(i + kDirections) % kDirections]}; };
  for (int i = 0; i < kDirections; ++i) smooth[i] = at(i - 2) + at(i + 2) + 4 * (at(i - 1) + at(i + 1)) + 6 * at(i);
  const std::int64_t highest = *std::max_element(smooth, smooth + kDirections);
  place.angles = 0;
  for (int i = 0; i < kDirections && place.angles < SiftScratch::kMostAngles; ++i) {
    const std::int64_t before = smooth[(i + kDirections - 1) % kDirections], here = smooth[i],
                       after = smooth[(i + 1) % kDirections];
    if (here <= before || here < after || 5 * here < 4 * highest) continue;
    const float offset = 0.5f * static_cast<float>(before - after) / static_cast<float>(before - 2 * here + after);
    float turns = (static_cast<float>(i) + offset) / kDirections;
    if (turns < 0) turns += 1;
    place.turns[place.angles++] = turns;
  }
}

void normalize(const std::int32_t* histogram, std::uint8_t* descriptor) {
  constexpr int kCount = SiftPoints::kDescriptor;
  std::int32_t bins[kCount];
  for (int row = 0, i = 0; row < kCells; ++row)
    for (int column = 0; column < kCells; ++column, i += kCellDirections)
      std::copy_n(histogram + ((row + 1) * kBins + column + 1) * kCellDirections, kCellDirections, bins + i);
  const auto length = [&] {
    std::int64_t squares = 0;  // 128 bins below 2^27.5 each
    for (const std::int64_t bin : bins) squares += bin * bin;
    return std::sqrt(static_cast<double>(squares));
  };
  const auto most = static_cast<std::int32_t>(0.2 * length());
  for (std::int32_t& bin : bins) bin = std::min(bin, most);
  const double scale = 512 / std::max(length(), 1.0);
  for (int i = 0; i < kCount; ++i)
    descriptor[i] = static_cast<std::uint8_t>(std::min(255, static_cast<int>(bins[i] * scale + 0.5)));
}

}  // namespace duo::sift
