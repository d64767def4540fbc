#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/speckle/speckle_params.h"

// Joins the runs of each row to those of the row above, once for each pair of runs that touch. Moves 8 bytes a pixel, 12
// operations, and for each pair the way up both trees.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer D { uint16_t d_q4[]; };
#include "stages/speckle/speckle_forest.glsl"

// Playne, Hawick: whoever finds that another one has joined its root elsewhere in the meantime, joins that place too.
void join_islands(uint a, uint b) {
  a = root(a);
  b = root(b);
  while (a != b) {
    const uint lower = min(a, b), upper = max(a, b), before = atomicMin(labels[upper], lower);
    b = lower;
    a = before == upper ? lower : before;
    if (a != b) a = root(a);
  }
}

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy), left = ivec2(1, 0), up = ivec2(0, 1);
  if (at.x >= p.width || at.y >= p.height || at.y == 0) return;
  const int d = value(at), above = value(at - up);
  if (!joined(d, above)) return;
  if (at.x > 0) {
    const int beside = value(at - left), corner = value(at - left - up);
    if (joined(d, beside) && joined(beside, corner) && joined(corner, above)) return;  // the pixel to the left does it
  }
  join_islands(label_index(at), label_index(at - up));
}
