// A rectified picture has black margins, where its camera sees nothing. Networks take them for what there is to see: legs that
// the picture cuts end there.
#pragma once

#include <vector>

#include "core/lens.h"
#include "duoptic/image.h"

namespace duo::body {

/// Copies pictures and repeats the picture's edge in the margins, as networks are taught beyond a picture's border.
class FilledMargin {
 public:
  FilledMargin() = default;
  /// `left`: the lens of the raw picture.
  FilledMargin(const Rectified& rectified, const Lens& left);
  /// Valid until the next call; the picture itself where it has no margin.
  ///
  /// Shape  rectified.size
  View<const Rgb8> fill(View<const Rgb8> picture);
  /// Not 0 in the margins. Empty without a lens.
  View<const std::uint8_t> mask() const { return mask_; }

 private:
  /// Units  px; `from`: the nearest pixel of the same column or row that the camera sees
  struct Repeated {
    int x, y, from_x, from_y;
  };
  Image<std::uint8_t> mask_;
  std::vector<Repeated> margin_;
  Image<Rgb8> filled_;
};

}  // namespace duo::body
