// What surfaces look like: procedural colours with fine detail.
#pragma once

#include "sources/synthetic/scene.h"

namespace duo::synthetic {

/// A point of a shape's surface in the shape's own frame.
struct TexturePoint {
  Vec3 p_m;
  Vec3 normal;
  Vec3 half_m;             // half extent of the shape
  double footprint_m = 0;  // size of a sample on the surface: finer detail is left out
  std::uint32_t seed = 0;  // tells shapes of one material apart
};

/// The diffuse reflectance there (times `emission`: the light given off).
Color texture(const Material& material, const TexturePoint& at);

}  // namespace duo::synthetic
