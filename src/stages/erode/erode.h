// Erosion of marks: single pixels and ragged edges go.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "duoptic/image.h"

namespace duo {

enum class Neighbours : std::uint8_t { kFour, kEight };

// Each bit stays where it is set in the pixel and in all its 4 or 8 neighbours.
//
// Shape    src and dst H x W, not the same memory
// Border   the picture continues by its edge pixels: what touches the border is not eaten from there. For marks that are 0
// outside
//          a window, a crop to that window grown by one pixel gives the same result
// Threads  rows are independent
// Exact    ref, simd and vk agree bit for bit
// Source   Serra, "Image Analysis and Mathematical Morphology", 1982
namespace ref {
void erode(View<const std::uint8_t> src, Neighbours neighbours, View<std::uint8_t> dst);
}
namespace simd {
void erode(Pool& pool, View<const std::uint8_t> src, Neighbours neighbours, View<std::uint8_t> dst);
}

}  // namespace duo
