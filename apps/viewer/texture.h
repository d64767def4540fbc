// A picture that ImGui draws.
#pragma once

#include <imgui/imgui.h>

#include "duoptic/image.h"
#include "duoptic/result.h"

namespace duo::app::view {

/// Pixels in the memory of the graphics card.
///
/// Threads  the window's, while it is open
class Texture {
 public:
  Texture() = default;
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;
  ~Texture();
  Size size() const { return size_; }

  /// Replaces the pixels; allocates only when the size is another one.
  ///
  /// Errors  the driver takes no picture as large as this one
  Result<void> set(View<const Rgb8> pixels);
  /// Draws the pixels between two corners, in window coordinates; nothing before the first set().
  void draw(ImDrawList& list, ImVec2 from, ImVec2 to) const;

 private:
  Size size_;
  unsigned name_ = 0;  // OpenGL's; 0: none
};

}  // namespace duo::app::view
