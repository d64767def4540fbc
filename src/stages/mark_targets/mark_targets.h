// Marks the pixels that fit the tracker's targets in colour, depth and place: up to six targets in one pass.
#pragma once

#include <cstdint>
#include <span>

#include "core/pool.h"
#include "core/targets.h"

namespace duo {

/// Bit t of a mark is set where the pixel lies in target t's window, fits its ColorModel, and passes its DepthGate.
///
/// Shape    all pictures and marks H x W; d_q4 and background_q4 may be empty = nothing known
/// Units    as in ColorModel and DepthGate
/// Border   windows may reach over it
/// Threads  rows are independent
/// Exact    ref, simd and vk agree bit for bit
/// Source   the colour blobs of Wren et al., "Pfinder", 1997, with a depth gate; likelihood tables as in Jones, Rehg,
/// "Statistical
///          color models with application to skin detection", 2002
struct MarkTargets {
  View<const std::uint8_t> hue, saturation, value;
  View<const std::uint16_t> d_q4 = {}, background_q4 = {};
  std::span<const Target> targets;                    // at most kMaxTargets
  std::span<const ColorLikelihood> likelihoods = {};  // what ColorModel::likelihood points into
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
