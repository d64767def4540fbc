#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/speckle/speckle_params.h"

// Removes the islands that are too small. Moves 10 bytes a pixel.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) buffer D { uint16_t d_q4[]; };
#include "stages/speckle/speckle_forest.glsl"

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height || value(at) == kNone) return;
  if (int(pixels[labels[label_index(at)]]) < p.smallest) d_q4[index(at)] = uint16_t(kNone);
}
