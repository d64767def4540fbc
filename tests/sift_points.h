// Made-up SIFT points for the stages that match them.
#pragma once

#include <random>

#include "stages/types/sift_points.h"
#include "tests/agree.h"

namespace duo::test {

/// Descriptors near a few centres, so that ratio and mutual checks go both ways; full range now and then.
inline SiftPoints random_points(int count, std::mt19937& rng) {
  SiftPoints points(count);
  points.count = count;
  for (int i = 0; i < count; ++i) {
    points[i].x_px = static_cast<float>(rng() % 200);
    points[i].y_px = static_cast<float>(rng() % 200);
    const unsigned centre = rng() % 7, spread = 1 + rng() % 12;
    for (int k = 0; k < SiftPoints::kDescriptor; ++k)
      points.descriptors.at(i, k) =
          static_cast<std::uint8_t>(centre == 0 ? 255 * (rng() & 1) : centre * 37 * static_cast<unsigned>(k) + rng() % spread);
  }
  return points;
}

}  // namespace duo::test
