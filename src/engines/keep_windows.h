// What lies outside the windows that matter is taken out of a frame.
#pragma once

#include <span>

#include "duoptic/frame.h"
#include "duoptic/window.h"

namespace duo {

/// Disparity, origin, confidence and depth outside all windows become none; maps that are not there stay so. No windows:
/// nothing happens.
void keep_windows(std::span<const Window> windows, Frame& frame);

}  // namespace duo
