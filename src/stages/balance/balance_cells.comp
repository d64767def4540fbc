#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#include "stages/balance/balance_params.h"

// An invocation a cell, the left view's first. Moves 4 bytes a pixel (with inside pictures).
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer Left { uint8_t left[]; };
layout(std430, binding = 1) readonly buffer Right { uint8_t right[]; };
layout(std430, binding = 2) readonly buffer LeftInside { uint8_t left_inside[]; };
layout(std430, binding = 3) readonly buffer RightInside { uint8_t right_inside[]; };
layout(std430, binding = 4) writeonly buffer Cells { uint cells[]; };  // [view][y][x]: mean, or kBalanceOutside
layout(push_constant) uniform Push { BalanceCellsPush p; };

int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }

void main() {
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (cell.x >= p.across || cell.y >= 2 * p.down) return;
  const bool is_right = cell.y >= p.down;
  const ivec2 first = kBalanceCell * ivec2(cell.x, is_right ? cell.y - p.down : cell.y);
  uint sum = kBalanceCell * kBalanceCell / 2;
  bool all_inside = true;
  for (int y = 0; y < kBalanceCell; ++y)
    for (int x = 0; x < kBalanceCell; ++x) {
      const ivec2 at = first + ivec2(x, y);
      sum += is_right ? uint(right[index(p.right, at)]) : uint(left[index(p.left, at)]);
      if (p.masked != 0)
        all_inside = all_inside && (is_right ? uint(right_inside[index(p.right_inside, at)])
                                             : uint(left_inside[index(p.left_inside, at)])) != 0;
    }
  cells[cell.y * p.across + cell.x] = sum / (kBalanceCell * kBalanceCell) | (all_inside ? 0 : kBalanceOutside);
}
