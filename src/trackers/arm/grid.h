// The working grid: the frame in cells of step x step pixels, so that every later step costs the same for any picture size.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "duoptic/frame.h"
#include "trackers/pinhole.h"

namespace duo::arm {

struct Rgb {
  float r = 0, g = 0, b = 0;
};

inline constexpr int kColorBins = 32 * 32;  // 32 of hue, of 32 of saturation each

/// Shape   all maps width x height, row by row
/// Memory  allocated by the constructor, reused by every build()
struct Grid {
  static constexpr int kMostColumns = 340;  // a hand at 2 m is still 20 cells long

  int width = 0, height = 0, step = 1;
  Pinhole camera;
  std::vector<float> z_m;            // 0 = unknown
  std::vector<Rgb> color;            // 0 .. 255
  std::vector<std::uint8_t> inside;  // 1 where the raw picture covers all of the cell

  Grid() = default;
  explicit Grid(const Rectified& rectified);
  void build(const Frame& frame);

  int size() const { return width * height; }
  int at(int x, int y) const { return y * width + x; }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
  bool known(int i) const { return z_m[static_cast<std::size_t>(i)] > 0; }
  double z(int i) const { return z_m[static_cast<std::size_t>(i)]; }
  Vec3 point(int i) const {
    const auto k = static_cast<std::size_t>(i);
    const double z = z_m[k];
    return {ray_x_[k] * z, ray_y_[k] * z, z};
  }
  /// Its hue and saturation as one of kColorBins; worked out when asked for, as few cells are.
  std::size_t color_bin(int i) const;
  /// Area that a cell covers on a surface seen head on.
  double area_m2(double z) const { return (z / camera.focal_px) * (z / camera.focal_px); }
  /// The cell that a point falls on; -1 = none.
  int cell_of(Vec3 p) const;
  /// One sigma of depth at z, from one of disparity in pixels of the full picture.
  double z_sigma_m(double z, double disparity_sigma_px) const {
    return z * z / (camera.focal_px * step * camera.baseline_m) * disparity_sigma_px;
  }

 private:
  template <int kStep>
  void build_row(const Frame& frame, int y);
  template <int kStep>
  void build_color(View<const Rgb8> picture, int y);
  template <int kStep>
  int median_q4(View<const std::uint16_t> d_q4, int x, int y) const;

  std::vector<float> ray_x_, ray_y_;  // slopes of the cells' rays
  std::vector<std::uint16_t> sum_;    // of a row of cells, by byte of the picture's rows
  std::vector<std::uint8_t> least_, most_;
};

/// Depth of the disc around a place of the grid, radius in cells: its median, or nearer where `nearness` is above one half.
/// None where fewer than three cells are known.
std::optional<double> disc_depth_m(const Grid& grid, Vec2 at, double radius, double nearness = 0.5);

/// Calls f(i) for the cells of the square of side 2 r + 1 around cell (x, y) that lie in the grid.
template <class F>
void each_around(const Grid& grid, int x, int y, int r, F&& f) {
  for (int v = std::max(0, y - r); v <= std::min(grid.height - 1, y + r); ++v)
    for (int u = std::max(0, x - r); u <= std::min(grid.width - 1, x + r); ++u) f(grid.at(u, v));
}

/// Keeps a set cell when at least `least` of its 3 x 3 are set: an erosion that spares thin fingers. `scratch` gets the old
/// mask.
void keep_majority(const Grid& grid, std::vector<std::uint8_t>& mask, std::vector<std::uint8_t>& scratch, int least);

}  // namespace duo::arm
