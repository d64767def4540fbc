#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#include "stages/balance/balance_params.h"

// The look-up. Moves 2 bytes a pixel and the table from the cache.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer Src { uint8_t src[]; };
layout(std430, binding = 1) readonly buffer Table { uint table[256]; };
layout(std430, binding = 2) writeonly buffer Dst { uint8_t dst[]; };
layout(push_constant) uniform Push { BalancePush p; };

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  dst[p.dst.offset + at.y * p.dst.stride + at.x] = uint8_t(table[uint(src[p.src.offset + at.y * p.src.stride + at.x])]);
}
