#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/mark_invalid/mark_invalid_params.h"

// Moves 6 bytes a pixel (with inside pictures), 6 operations.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer Winner { int16_t winner[]; };
layout(std430, binding = 1) readonly buffer LeftInside { uint8_t left_inside[]; };
layout(std430, binding = 2) readonly buffer RightInside { uint8_t right_inside[]; };
layout(std430, binding = 3) writeonly buffer Dst { uint16_t dst[]; };
layout(push_constant) uniform Push { MarkInvalidPush p; };

int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }

bool inside(ivec2 at, int d) {
  return p.masked == 0 || (uint(left_inside[index(p.left_inside, at)]) != 0 &&
                           uint(right_inside[index(p.right_inside, at - ivec2(d, 0))]) != 0);
}

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  const int d = int(winner[index(p.winner, at)]);
  const bool possible = d >= 0 && d < p.max_disparity && d <= at.x;
  dst[index(p.dst, at)] = uint16_t(possible && inside(at, d) ? 16 * d : 0xFFFF);
}
