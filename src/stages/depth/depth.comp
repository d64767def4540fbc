#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/depth/depth_params.h"

// Moves 4 bytes a pixel, and reads the table once, from the cache: of its 128 kB only 32 bytes for each whole disparity that
// occurs.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer Src { uint16_t src[]; };
layout(std430, binding = 1) readonly buffer Table { uint16_t table[]; };
layout(std430, binding = 2) writeonly buffer Dst { uint16_t dst[]; };
layout(push_constant) uniform Push { DepthPush p; };

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  const uint d = uint(src[p.src.offset + at.y * p.src.stride + at.x]);
  dst[p.dst.offset + at.y * p.dst.stride + at.x] = table[d];
}
