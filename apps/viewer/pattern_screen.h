// A display, or a projector that is one, covered by patterns.
#pragma once

#include <memory>

#include "duoptic/structured_light.h"

namespace duo::app::view {

/// A screen and the pixels that it has.
struct PatternScreen {
  std::unique_ptr<LightScreen> screen;
  Size size;
};

/// Covers a display, counted from 0. Its user ends it by Escape or Q.
///
/// Errors  those of Window::open(); there is no such display
Result<PatternScreen> open_pattern_screen(int display);

}  // namespace duo::app::view
