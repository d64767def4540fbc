#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/check_left_right/check_left_right_params.h"

// Moves 10 bytes a pixel (with inside pictures; the reads of the right view come from the cache), 8 + 6 (2 reach + 1) operations.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer Left { int16_t left[]; };
layout(std430, binding = 1) readonly buffer Right { int16_t right[]; };
layout(std430, binding = 2) readonly buffer LeftInside { uint8_t left_inside[]; };
layout(std430, binding = 3) readonly buffer RightInside { uint8_t right_inside[]; };
layout(std430, binding = 4) readonly buffer Value { uint16_t value[]; };  // winners or fine disparities
layout(std430, binding = 5) writeonly buffer Dst { uint16_t dst[]; };
layout(push_constant) uniform Push { CheckLeftRightPush p; };

const uint kNone = 0xFFFF;  // of fine disparities, and -1 of winners

int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }

bool consistent(ivec2 at) {
  const int d = int(left[index(p.left, at)]), partner = at.x - d;
  if (d < 0 || partner < 0) return false;
  if (p.masked != 0 && (uint(left_inside[index(p.left_inside, at)]) == 0 ||
                        uint(right_inside[index(p.right_inside, ivec2(partner, at.y))]) == 0))
    return false;
  for (int x = max(partner - p.reach, 0); x <= min(partner + p.reach, p.width - 1); ++x) {
    const int other = int(right[index(p.right, ivec2(x, at.y))]);
    if (other >= 0 && abs(other - d) <= p.tolerance) return true;
  }
  return false;
}

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  dst[index(p.dst, at)] = uint16_t(consistent(at) ? uint(value[index(p.value, at)]) : kNone);
}
