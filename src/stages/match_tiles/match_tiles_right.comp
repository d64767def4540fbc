#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/match_tiles/match_tiles_params.h"

// The right view's winners from cost << 16 | d, all ones where nothing was tried. Moves 6 bytes a pixel.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer RightBest { uint right_best[]; };
layout(std430, binding = 1) writeonly buffer Dst { int16_t dst[]; };
layout(push_constant) uniform Push { MatchRightPush p; };

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  dst[p.dst.offset + at.y * p.dst.stride + at.x] = int16_t(right_best[at.y * p.width + at.x] & 0xFFFF);
}
