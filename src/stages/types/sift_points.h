// Scale-invariant points with descriptors, between the stage that finds them and the stage that matches them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "duoptic/image.h"

namespace duo {

struct SiftPoint {
  float x_px = 0, y_px = 0;  // of the picture; pixel centres are whole numbers
  float scale_px = 0;        // sigma of the Gaussian at which the point was found
  float angle_rad = 0;       // in [0, 2 pi], from x right towards y down
  float response = 0;        // |difference of Gaussians| at the refined place, as a share of the gray range
  std::uint8_t octave = 0, level = 0;
  friend bool operator==(const SiftPoint&, const SiftPoint&) = default;
};

/// Up to `capacity` points; what found no room is counted. Allocates once.
struct SiftPoints {
  static constexpr int kDescriptor = 128;  // bytes

  std::vector<SiftPoint> points;    // capacity elements, of which count are valid
  Image<std::uint8_t> descriptors;  // row i belongs to points[i]
  int count = 0, overflow = 0;

  SiftPoints() = default;
  explicit SiftPoints(int capacity) : points(static_cast<std::size_t>(capacity)), descriptors({kDescriptor, capacity}) {}
  int capacity() const { return static_cast<int>(points.size()); }
  const SiftPoint& operator[](int i) const { return points[static_cast<std::size_t>(i)]; }
  SiftPoint& operator[](int i) { return points[static_cast<std::size_t>(i)]; }
};

/// Which seen point a stored one is.
struct PointMatch {
  static constexpr int kNone = -1;
  std::int32_t seen = kNone;         // index
  std::int32_t square_distance = 0;  // of the descriptors
  friend bool operator==(const PointMatch&, const PointMatch&) = default;
};

}  // namespace duo
