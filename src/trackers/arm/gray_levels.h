// The rectified left picture in gray, at most 680 columns, and at half that size.
#pragma once

#include <cstdint>
#include <vector>

#include "duoptic/frame.h"
#include "trackers/pinhole.h"

namespace duo::arm {

struct GrayLevel {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;

  const std::uint8_t* at(int x, int y) const { return pixels.data() + static_cast<std::ptrdiff_t>(y) * width + x; }
};

struct GrayLevels {
  static constexpr int kMostColumns = 680;

  int step = 1;    // pixels of the frame in one of `full`
  Pinhole camera;  // of `full`
  GrayLevel full, half;

  GrayLevels() = default;
  explicit GrayLevels(const Rectified& rectified);
  void build(const Frame& frame);
};

}  // namespace duo::arm
