#include "trackers/arm/grid.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"
#include "duoptic/statistics.h"

namespace duo::arm {
namespace {

constexpr int kMostStep = 16;

/// The median of those of four that are known, the others being 0; 0 of none. In order the zeros come first, so that it is the
/// third of all where three or four are known, else the last.
int median_known(int a, int b, int c, int d) {
  const int low_ab = std::min(a, b), high_ab = std::max(a, b), low_cd = std::min(c, d), high_cd = std::max(c, d);
  const int third = std::max(std::max(low_ab, low_cd), std::min(high_ab, high_cd));
  const int known = (a > 0) + (b > 0) + (c > 0) + (d > 0);
  return known >= 3 ? third : std::max(high_ab, high_cd);
}

int known_or_zero(std::uint16_t d_q4) { return d_q4 == Disparity::kNone ? 0 : d_q4; }

}  // namespace

Grid::Grid(const Rectified& rectified)
    : step(std::clamp((rectified.size.width + kMostColumns / 2) / kMostColumns, 1, kMostStep)) {
  width = rectified.size.width / step;
  height = rectified.size.height / step;
  camera = in_blocks(rectified, step);
  const auto n = static_cast<std::size_t>(size());
  z_m.resize(n);
  color.resize(n);
  inside.resize(n);
  const auto bytes = static_cast<std::size_t>(width * step * 3);
  sum_.resize(bytes);
  least_.resize(bytes);
  most_.resize(bytes);
  for (int i = 0; i < size(); ++i) {
    ray_x_.push_back(static_cast<float>((i % width - camera.cx_px) / camera.focal_px));
    ray_y_.push_back(static_cast<float>((i / width - camera.cy_px) / camera.focal_px));
  }
}

void Grid::build(const Frame& frame) {
  DUO_CHECK(frame.color.size() == frame.disparity.d_q4.size() && frame.color.width() / step == width &&
            frame.color.height() / step == height);
  for (int y = 0; y < height; ++y) switch (step) {
      case 1:
        build_row<1>(frame, y);
        break;
      case 2:
        build_row<2>(frame, y);
        break;
      case 4:
        build_row<4>(frame, y);
        break;
      default:
        build_row<0>(frame, y);
    }
}

/// kStep: the step as a constant, so that the inner loops unroll; 0 = any.
template <int kStep>
void Grid::build_row(const Frame& frame, int y) {
  const int s = kStep > 0 ? kStep : step;
  build_color<kStep>(frame.color, y);
  const float z_of_q4 = static_cast<float>(camera.focal_px * step * camera.baseline_m * 16);
  for (int x = 0; x < width; ++x) {
    const auto i = static_cast<std::size_t>(at(x, y));
    const int d_q4 = median_q4<kStep>(frame.disparity.d_q4, x * s, y * s);
    z_m[i] = d_q4 == 0 ? 0 : z_of_q4 / static_cast<float>(d_q4);
    inside[i] = 1;
  }
  if (frame.left_inside.empty()) return;
  for (int v = y * s; v < (y + 1) * s; ++v) {
    const std::uint8_t* in = frame.left_inside.row(v);
    std::uint8_t* out = &inside[static_cast<std::size_t>(at(0, y))];
    for (int x = 0; x < width; ++x)
      for (int u = 0; u < s; ++u) out[x] &= in[x * s + u] != 0;
  }
}

/// Each channel's mean without its smallest and its largest value, once that leaves something. First down the columns, byte by
/// byte as they lie in memory, then across them.
template <int kStep>
void Grid::build_color(View<const Rgb8> picture, int y) {
  const int s = kStep > 0 ? kStep : step, pixels = s * s;
  const std::size_t bytes = sum_.size();
  std::uint16_t* sum = sum_.data();
  std::uint8_t *least = least_.data(), *most = most_.data();
  std::fill_n(sum, bytes, std::uint16_t{0});
  std::fill_n(least, bytes, std::uint8_t{255});
  std::fill_n(most, bytes, std::uint8_t{0});
  for (int v = y * s; v < (y + 1) * s; ++v) {
    const std::uint8_t* in = &picture.row(v)->r;
    for (std::size_t i = 0; i < bytes; ++i) {
      sum[i] = static_cast<std::uint16_t>(sum[i] + in[i]);  // of 16 rows at most
      least[i] = std::min(least[i], in[i]);
      most[i] = std::max(most[i], in[i]);
    }
  }
  const auto mean = [&](std::size_t i) {
    int all = 0;
    std::uint8_t low = 255, high = 0;
    for (int u = 0; u < s; ++u, i += 3) {
      all += sum[i];
      low = std::min(low, least[i]);
      high = std::max(high, most[i]);
    }
    return pixels < 4 ? static_cast<float>(all) / static_cast<float>(pixels)
                      : static_cast<float>(all - low - high) / static_cast<float>(pixels - 2);
  };
  for (int x = 0; x < width; ++x) {
    const auto i = static_cast<std::size_t>(x * s * 3);
    color[static_cast<std::size_t>(at(x, y))] = {mean(i), mean(i + 1), mean(i + 2)};
  }
}

/// Of the cell's pixels, the first of them at (x, y); 0 where less than a quarter is known.
template <int kStep>
int Grid::median_q4(View<const std::uint16_t> d_q4, int x, int y) const {
  if constexpr (kStep == 2) {  // what a VGA picture has
    const std::uint16_t *upper = d_q4.row(y) + x, *lower = d_q4.row(y + 1) + x;
    return median_known(known_or_zero(upper[0]), known_or_zero(upper[1]), known_or_zero(lower[0]), known_or_zero(lower[1]));
  }
  const int s = kStep > 0 ? kStep : step;
  std::array<std::uint16_t, kMostStep * kMostStep + 1> all;  // the last is written and not counted
  int known = 0;
  for (int v = y; v < y + s; ++v)
    for (const std::uint16_t *d = d_q4.row(v) + x, *end = d + s; d != end; ++d) {
      all[static_cast<std::size_t>(known)] = *d;
      known += *d != 0 && *d != Disparity::kNone;
    }
  return known == 0 || known * 4 < s * s ? 0 : median(std::span(all).first(static_cast<std::size_t>(known)));
}

// Hexcone model (Smith, 1978), as in the stage hsv.
std::size_t Grid::color_bin(int i) const {
  const Rgb c = color[static_cast<std::size_t>(i)];
  const float most = std::max({c.r, c.g, c.b}), least = std::min({c.r, c.g, c.b}), spread = most - least;
  float hue = 0;  // sixths of a circle
  if (spread > 0) {
    if (most == c.r)
      hue = (c.g - c.b) / spread;
    else if (most == c.g)
      hue = 2 + (c.b - c.r) / spread;
    else
      hue = 4 + (c.r - c.g) / spread;
    if (hue < 0) hue += 6;
  }
  const float saturation = most > 0 ? spread / most : 0;
  const int hue_bin = std::min(31, static_cast<int>(hue * (32.0F / 6))),
            saturation_bin = std::min(31, static_cast<int>(saturation * 32));
  return static_cast<std::size_t>(hue_bin * 32 + saturation_bin);
}

int Grid::cell_of(Vec3 p) const {
  if (p.z < 0.1) return -1;
  const Vec2 q = camera.project(p);
  if (!(q.x > -0.5 && q.y > -0.5 && q.x < width - 0.5 && q.y < height - 0.5)) return -1;
  return at(static_cast<int>(q.x + 0.5), static_cast<int>(q.y + 0.5));
}

std::optional<double> disc_depth_m(const Grid& grid, Vec2 at, double radius, double nearness) {
  constexpr int kMost = 512;  // cells: radius up to 12
  std::array<float, kMost> z;
  std::size_t n = 0;
  const int r = static_cast<int>(std::ceil(radius)), x = static_cast<int>(std::lround(at.x)),
            y = static_cast<int>(std::lround(at.y));
  for (int j = -r; j <= r; ++j)
    for (int i = -r; i <= r; ++i)
      if (i * i + j * j <= radius * radius + 0.01 && grid.contains(x + i, y + j) && grid.known(grid.at(x + i, y + j)) &&
          n < kMost)
        z[n++] = static_cast<float>(grid.z(grid.at(x + i, y + j)));
  if (n < 3) return {};
  return nth(std::span(z).first(n), static_cast<std::size_t>((1 - nearness) * static_cast<double>(n - 1) + 0.5));
}

void keep_majority(const Grid& grid, std::vector<std::uint8_t>& mask, std::vector<std::uint8_t>& scratch, int least) {
  scratch = mask;
  const auto w = static_cast<std::ptrdiff_t>(grid.width);
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      const int i = grid.at(x, y);
      std::uint8_t& out = mask[static_cast<std::size_t>(i)];
      if (!out) continue;
      out = 0;
      if (x == 0 || y == 0 || x == grid.width - 1 || y == grid.height - 1) continue;
      const std::uint8_t* p = scratch.data() + i;
      const int set = p[-w - 1] + p[-w] + p[-w + 1] + p[-1] + p[0] + p[1] + p[w - 1] + p[w] + p[w + 1];
      out = set >= least;
    }
}

}  // namespace duo::arm
