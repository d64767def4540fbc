// Places of matched points to a small part of a pixel: the patch around one is laid over the other picture.
#pragma once

#include <optional>

#include "core/lens.h"
#include "duoptic/image.h"

namespace duo {

/// A picture with what its pixels differ by from left to right and from top to bottom, half of both neighbours' difference; 0
/// on the border.
struct SlopedPixel {
  float value, slope_x, slope_y, none;  // none: 0, so that four values are read at once
};
void put_slopes(View<const float> picture, Image<SlopedPixel>& out);

/// Which matches count.
struct AlignLimits {
  double least_correlation = 0.9;
  double noise_gray = 2;       // of either picture
  double most_sigma_px = 0.1;  // that this noise leaves unknown of the row
};

/// Where the patch around `left_px` lies in the right picture, near `right_px`. There it may be stretched and sheared along the
/// rows (a wall seen from two places), brighter and of more contrast.
///
/// None    the patch, or what it may be stretched to, reaches over a border; it moves by more than its radius; it does not
/// settle
///         (too little texture along one direction); it does not look the same there
/// Units   px; the patch has 2 radius_px + 1 rows and columns
/// Source  Lucas, Kanade, "An iterative image registration technique", 1981; with gain and offset as in Baker, Matthews,
///         "Lucas-Kanade 20 years on", part 3, 2003
std::optional<Vec2> align_match(View<const float> left, Vec2 left_px, View<const SlopedPixel> right, Vec2 right_px,
                                int radius_px, const AlignLimits& limits = {});

}  // namespace duo
