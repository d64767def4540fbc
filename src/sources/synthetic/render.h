// Pictures of a scene as a camera without noise would take them, and what each pixel shows.
#pragma once

#include "core/pool.h"
#include "duoptic/frame.h"
#include "sources/synthetic/lens.h"
#include "sources/synthetic/light.h"
#include "sources/synthetic/scene.h"

namespace duo::synthetic {

/// What the ray through a pixel's centre meets.
struct Surface {
  int shape = -1;  // -1: nothing
  double z_m = 0;  // in the camera
  Vec3 p_in_world_m, normal;
};

struct Rendering {
  Image<Surface> surfaces;
  Image<Color> colors;  // linear light, mean of four points of the pixel
};

/// Casts rays in three passes: what each pixel shows; the light there, estimated in turns over 4x4 pixels and averaged
/// over neighbours on the same surface; the colours, with textures and edges at four points a pixel.
///
/// Exact  the same bits with any number of threads
Rendering render(Pool& pool, const Scene& scene, const Camera& camera, const Rigid3& world_from_camera);

}  // namespace duo::synthetic
