// Pictures in which nothing can be matched.
#pragma once

#include <memory>

#include "duoptic/frame.h"

namespace duo {

/// True for a picture without structure: a lens cap, a blank wall, the first pictures of a webcam. Light that falls off slowly
/// and noise are no structure. Compares the means of neighbouring blocks of 4x4 pixels with each other and with the noise;
/// mostly its first rows tell.
bool is_flat(View<const Rgb8> picture);

/// The frame with nothing known of its depth: every disparity of a flat picture is as good as any other, and a matcher's least
/// cost says nothing.
std::shared_ptr<const Frame> without_depth(std::shared_ptr<const Frame> frame);

}  // namespace duo
