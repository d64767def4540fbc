#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/speckle/speckle_params.h"

// First labels: each pixel's is where its run begins inside the workgroup's part of the row; a run that comes from the part before
// points there. Moves 10 bytes a pixel, 12 operations.
layout(local_size_x = kSpeckleRun) in;
layout(std430, binding = 0) readonly buffer D { uint16_t d_q4[]; };
#include "stages/speckle/speckle_forest.glsl"

shared uint begins[kSpeckleRun / 32];  // bit of each pixel that is not joined to the one before it

void main() {
  const int lane = int(gl_LocalInvocationIndex);
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (lane < kSpeckleRun / 32) begins[lane] = 0;
  barrier();
  const bool here = at.x < p.width;
  const bool continues = here && at.x > 0 && joined(value(at), value(at - ivec2(1, 0)));
  if (!continues || lane == 0) atomicOr(begins[lane / 32], 1u << lane % 32);
  barrier();
  if (!here) return;

  int word = lane / 32;
  uint bits = begins[word] & 0xFFFFFFFFu >> 31 - lane % 32;
  while (bits == 0) bits = begins[--word];  // bit 0 of the first word is always set
  const int back = lane - (32 * word + findMSB(bits));
  const uint i = label_index(at);
  labels[i] = i - back - (lane == 0 && continues ? 1 : 0);
  pixels[i] = 0;
}
