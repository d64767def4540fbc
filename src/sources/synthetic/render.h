// Pictures of a scene as a camera without noise would take them, and what each pixel shows.
#pragma once

#include "core/pool.h"
#include "duoptic/frame.h"
#include "sources/synthetic/shading.h"

namespace duo::synthetic {

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
