// Focus and exposure of a picture as numbers, for who turns a lens or a lamp.
#pragma once

#include "duoptic/image.h"

namespace [[gnu::visibility("default")]] duo {

struct PictureFigures {
  double focus = 0;               // the larger the sharper, of one scene; 0 of a picture of one colour
  double brightness_percent = 0;  // mean; 100 is white
  double white_percent = 0;       // pixels whose brightness is 250 or more of 255: nothing is seen in them
};

/// Focus is the root of the mean square of the gray picture's Laplacian (four neighbours), in percent of the standard deviation
/// of its brightness, so that more light or contrast does not change it.
///
/// Shape   H x W, 3 x 3 or more; the border has no Laplacian
/// Source  Pech-Pacheco et al., "Diatom autofocusing in brightfield microscopy: a comparative study", 2000
PictureFigures picture_figures(View<const Rgb8> picture);

}  // namespace duo
