#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#include "stages/halve/halve_params.h"

// Moves 5 bytes a pixel of the result, 5 operations.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer Src { uint8_t src[]; };
layout(std430, binding = 1) writeonly buffer Dst { uint8_t dst[]; };
layout(push_constant) uniform Push { HalvePush p; };

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  const ivec2 last = ivec2(p.width, p.height) - 1, first = 2 * at;
  if (any(greaterThan(first, last))) return;
  const ivec2 second = min(first + 1, last);
  const int upper = p.src.offset + first.y * p.src.stride, lower = p.src.offset + second.y * p.src.stride;
  const uint a = uint(src[upper + first.x]), b = uint(src[upper + second.x]);
  const uint c = uint(src[lower + first.x]), d = uint(src[lower + second.x]);
  dst[p.dst.offset + at.y * p.dst.stride + at.x] = uint8_t(p.all != 0 ? a & b & c & d : (a + b + c + d + 2) >> 2);
}
