// A synthetic rig in a synthetic room: pictures with exact depth, made by our own renderer.
#pragma once

#include <cstdint>

#include "duoptic/frame.h"
#include "duoptic/rig.h"

namespace duo {

struct SyntheticSetup {
  Size size = {640, 480};
  std::uint32_t seed = 1;   // layout, textures, mounting errors and noise
  double t_s = 0;           // moment of the scene: a ball swings, a globe turns
  bool ideal = false;       // true: rectified pinhole cameras without noise or distortion
};

/// One moment of the scene seen by both cameras, with its truth.
///
/// Shape   all H x W of setup.size
/// Units   depth_left_m: z of the first surface in the raw left camera, metres, at each raw left pixel (through its
///         distortion); disparity_px: exact x_left - x_right of the ideal pair, only when `ideal`
struct SyntheticPair {
  Pair pair;
  Rig rig;
  Image<float> depth_left_m;
  Image<float> disparity_px;
  Image<std::uint8_t> seen_by_both;  // 255 where the right camera sees the same surface point, only when `ideal`
};

/// Renders one moment. The same setup gives the same bits on every machine and with any number of threads.
SyntheticPair render_synthetic(const SyntheticSetup& setup, int threads);

/// The rig of a setup without rendering: two webcams mounted by hand, or the perfect pair when `ideal`.
Rig synthetic_rig(const SyntheticSetup& setup);

/// The rectified geometry of the ideal pair.
Rectified synthetic_rectified(const SyntheticSetup& setup);

}  // namespace duo
