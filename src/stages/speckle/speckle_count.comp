#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/speckle/speckle_params.h"

// Labels become roots, and roots count their pixels until there are enough: else all pixels of a large island would wait
// for one word. Moves 6 bytes a pixel and the way up.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer D { uint16_t d_q4[]; };
#include "stages/speckle/speckle_forest.glsl"

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height || value(at) == kNone) return;
  const uint i = label_index(at), island = root(i);
  if (island != i) atomicMin(labels[i], island);
  if (int(pixels[island]) < p.smallest) atomicAdd(pixels[island], 1);
}
