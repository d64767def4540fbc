// Anisotropic diffusion: noise flows away within surfaces and stops at their edges.
#pragma once

#include <array>
#include <cstdint>

#include "core/pool.h"
#include "duoptic/image.h"

namespace duo {

/// In each of kSweeps sweeps all pixels at once take a quarter of what flows to them from their four neighbours, rounded to the
/// nearest: f(d) of each difference d, rounded to the nearest. f(d) = d g(|d|), g = kConductance[i] / 256, i the difference in
/// steps of two gray levels, rounded down; 0 from 32 gray levels on.
///
/// Shape    src and dst H x W, may be the same memory
/// Units    gray levels; in between 1/64 of one, so that small differences flow, too
/// Border   edge pixels continue: nothing flows over the border
/// Threads  rows are independent within a sweep
/// Exact    ref and simd agree bit for bit: integers of 16 bits
/// Source   Perona, Malik, "Scale-space and edge detection using anisotropic diffusion", 1990, with their exponential
///          conductance, exp(-(d / K)^2), K = kEdge
struct Diffusion {
  static constexpr int kSweeps = 5, kEdge = 10, kBits = 6;
  /// round(255 exp(-((2 i + 1) / kEdge)^2)).
  alignas(16) static constexpr std::array<std::uint8_t, 16> kConductance = {252, 233, 199, 156, 113, 76, 47, 27,
                                                                            14,  7,   3,   1,   0,   0,  0,  0};
};

namespace ref {
void diffuse(View<const std::uint8_t> src, View<std::uint8_t> dst);
}
namespace simd {
/// Two pictures in 1/64 of a gray level, with a column on both sides.
struct DiffusionScratch {
  explicit DiffusionScratch(Size size);
  Image<std::int16_t> now, next;
};
void diffuse(Pool& pool, View<const std::uint8_t> src, DiffusionScratch& scratch, View<std::uint8_t> dst);
}  // namespace simd

}  // namespace duo
