// What a cheap camera makes of the light: blur, vignetting, colour cast, noise, sRGB in 8 bits.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "duoptic/image.h"
#include "sources/synthetic/scene.h"

namespace duo::synthetic {

/// The defaults are a perfect camera.
struct Webcam {
  Color gain = {1, 1, 1};  // exposure and white balance
  double blur = 0;         // weight of the two neighbours in a 3-tap kernel, each way
  double vignetting = 0;   // light lost in the corners, as a share
  double shot_noise = 0;   // sigma at full light; grows with the root of the light
  double read_noise = 0;   // sigma in the dark
  std::uint32_t seed = 0;  // of the noise: differs from camera to camera and picture to picture
};

/// Shape  raw and picture H x W
Image<Rgb8> develop(Pool& pool, const Image<Color>& raw, const Webcam& webcam);

}  // namespace duo::synthetic
