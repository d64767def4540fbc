// The two cameras of a synthetic rig: lenses, mounts and sensors.
#pragma once

#include "duoptic/synthetic.h"
#include "sources/synthetic/webcam.h"

namespace duo::synthetic {

inline constexpr double kBaseline_m = 0.127;

struct Mounted {
  Camera camera;
  Rigid3 rig_from_camera;
};
struct Mounting {
  Mounted left, right;
};

/// The perfect camera of a size.
Camera ideal_camera(Size size);

/// Two webcams of one make, screwed on a bar by hand: every lens and every mount is a little off. Or the perfect pair.
Mounting mounting(const SyntheticSetup& setup);
Rig rig_of(const Mounting& mounting);

/// The sensor of the left (0) or right (1) camera at setup.t_s.
Webcam webcam(const SyntheticSetup& setup, std::uint32_t which);

Picture taken(Image<Rgb8> pixels, double t_s);

}  // namespace duo::synthetic
