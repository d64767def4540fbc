#include "trackers/arm/grid.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"
#include "core/targets.h"

namespace duo::arm {
namespace {

constexpr int kMostStep = 16;

/// The mean of n values (added up in `sum`) without the smallest and the largest, once that leaves something.
struct Trimmed {
  int sum = 0, least = 255, most = 0;
  void add(int v) {
    sum += v;
    least = std::min(least, v);
    most = std::max(most, v);
  }
  float mean(int n) const {
    return n < 4 ? static_cast<float>(sum) / static_cast<float>(n)
                 : static_cast<float>(sum - least - most) / static_cast<float>(n - 2);
  }
};

/// The value at n / 2 in order. Four is what nearly every cell of a VGA picture has: the larger of the two in the middle.
std::uint16_t upper_median(std::uint16_t* v, int n) {
  if (n == 4)
    return std::max(std::max(std::min(v[0], v[1]), std::min(v[2], v[3])), std::min(std::max(v[0], v[1]), std::max(v[2], v[3])));
  std::nth_element(v, v + n / 2, v + n);
  return v[n / 2];
}

}  // namespace

Grid::Grid(const Rectified& rectified)
    : step(std::clamp((rectified.size.width + kMostColumns / 2) / kMostColumns, 1, kMostStep)) {
  width = rectified.size.width / step;
  height = rectified.size.height / step;
  camera = Pinhole::of(rectified).coarser(step);
  const auto n = static_cast<std::size_t>(size());
  z_m.resize(n);
  color.resize(n);
  inside.resize(n);
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
  const int s = kStep > 0 ? kStep : step, pixels = s * s;
  const float z_of_q4 = static_cast<float>(camera.focal_px * step * camera.baseline_m * 16);
  std::array<std::uint16_t, kMostStep * kMostStep + 1> d_q4;  // the last is written and not counted
  for (int x = 0; x < width; ++x) {
    int known = 0;
    bool covered = true;
    Trimmed r, g, b;
    for (int v = y * s; v < (y + 1) * s; ++v) {
      const std::uint16_t* d = frame.disparity.d_q4.row(v) + x * s;
      const Rgb8* c = frame.color.row(v) + x * s;
      for (int u = 0; u < s; ++u) {
        d_q4[static_cast<std::size_t>(known)] = d[u];
        known += d[u] != 0 && d[u] != Disparity::kNone;
        r.add(c[u].r);
        g.add(c[u].g);
        b.add(c[u].b);
      }
      if (frame.left_inside.empty()) continue;
      const std::uint8_t* in = frame.left_inside.row(v) + x * s;
      for (int u = 0; u < s; ++u) covered &= in[u] != 0;
    }
    const auto i = static_cast<std::size_t>(at(x, y));
    inside[i] = covered;
    color[i] = {r.mean(pixels), g.mean(pixels), b.mean(pixels)};
    z_m[i] = known == 0 || known * 4 < pixels ? 0 : z_of_q4 / static_cast<float>(upper_median(d_q4.data(), known));
  }
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
  const auto wanted = z.begin() + static_cast<std::ptrdiff_t>((1 - nearness) * static_cast<double>(n - 1) + 0.5);
  std::nth_element(z.begin(), wanted, z.begin() + static_cast<std::ptrdiff_t>(n));
  return *wanted;
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
