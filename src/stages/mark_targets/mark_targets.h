// Marks the pixels of several colours, each in its own window: up to six targets in one pass.
#pragma once

#include <cstdint>
#include <span>

#include "core/pool.h"
#include "duoptic/image.h"
#include "duoptic/window.h"

namespace duo {

inline constexpr int kMaxTargets = 6;  // both arms: hand, elbow, shoulder

/// A pixel fits where saturation and value reach their minima and its hue lies within `hue_tolerance` of `hue` around the
/// circle.
///
/// Units   hue 256 = full circle; a tolerance of 128 takes every hue
struct ColorModel {
  std::uint8_t hue = 0, hue_tolerance = 128;
  std::uint8_t min_saturation = 0, min_value = 0;
};

struct Target {
  ColorModel color;
  Window window;
};

/// Bit t of a mark is set where the pixel lies in target t's window and fits its colour.
///
/// Shape    all pictures and marks H x W
/// Border   windows may reach over it
/// Threads  rows are independent
/// Exact    ref, simd and vk agree bit for bit
/// Source   the colour blobs of Wren et al., "Pfinder", 1997
struct MarkTargets {
  View<const std::uint8_t> hue, saturation, value;
  std::span<const Target> targets;  // at most kMaxTargets
};

namespace ref {
/// The definition for one pixel, window aside.
bool fits(const MarkTargets& in, const Target& target, int y, int x);
void mark_targets(const MarkTargets& in, View<std::uint8_t> marks);
}  // namespace ref
namespace simd {
void mark_targets(Pool& pool, const MarkTargets& in, View<std::uint8_t> marks);
}

}  // namespace duo
