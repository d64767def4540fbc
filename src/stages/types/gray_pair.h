// What matchers see: both rectified gray pictures and where they are covered by the raw ones.
#pragma once

#include <cstdint>

#include "duoptic/image.h"

namespace duo {

/// Shape   all H x W; the inside pictures (255 inside, 0 outside) may be empty = all inside, the colour ones = not asked for
struct GrayPair {
  View<const std::uint8_t> left = {}, right = {}, left_inside = {}, right_inside = {};
  std::uint64_t turn = 0;  // which of its stream, from 0
  View<const Rgb8> left_color = {}, right_color = {};
  int coding_noise_q4 = 0;  // of the noisier picture, sigma in 1/16 gray levels; 0: none, or not known
  Size size() const { return left.size(); }
  bool masked() const { return !left_inside.empty(); }
};

}  // namespace duo
