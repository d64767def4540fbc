#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/balance/balance_params.h"

// An invocation a cell, the left view's first.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer Cells { uint cells[]; };     // [view][y][x]: mean, or with kBalanceOutside
layout(std430, binding = 1) writeonly buffer Census { uint census[]; };  // [view][y][x]: 24 bits, or with kBalanceOutside
layout(push_constant) uniform Push { BalanceCensusPush p; };

void main() {
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (cell.x >= p.across || cell.y >= 2 * p.down) return;
  const int top = cell.y >= p.down ? p.down : 0;
  uint around[kBalanceAround], outside = 0;
  int count = 0;
  for (int dy = -kBalanceReach; dy <= kBalanceReach; ++dy)
    for (int dx = -kBalanceReach; dx <= kBalanceReach; ++dx) {
      const int y = cell.y + dy, x = cell.x + dx;
      const bool in_picture = y >= top && y < top + p.down && x >= 0 && x < p.across;
      const uint there = in_picture ? cells[y * p.across + x] : kBalanceOutside;
      outside |= there;
      if (dy != 0 || dx != 0) around[count++] = there;
    }
  uint bits = 0;  // where one is outside, they do not matter
  for (int i = 0; i < kBalanceAround; ++i)
    if (around[i] < around[(i + kBalanceApart) % kBalanceAround]) bits |= 1u << i;
  census[cell.y * p.across + cell.x] = bits | outside & kBalanceOutside;
}
