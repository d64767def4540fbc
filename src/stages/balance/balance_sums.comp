#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "stages/balance/balance_params.h"

// A workgroup a row of cells, an invocation every so many left cells. Each looks for its nearest right cell, and for that one's
// nearest left one: twice as many comparisons as disparities, in cells.
layout(local_size_x = kBalanceGroup) in;
layout(std430, binding = 0) readonly buffer Cells { uint cells[]; };    // [view][y][x]: mean
layout(std430, binding = 1) readonly buffer Census { uint census[]; };  // [view][y][x]: 24 bits, or with kBalanceOutside
layout(std430, binding = 2) writeonly buffer Rows { uint rows[]; };     // [view][y][kBalanceSums]
layout(push_constant) uniform Push { BalanceSumsPush p; };

shared uint totals[2 * kBalanceSums];

// The disparity, in cells, at which a cell's nearest lies; -1 = none is alike. `sign` -1: of a left one, 1: of a right one.
int nearest(int here, int x, int there, int sign) {
  int best = -1, least = kBalanceAlike + 1;
  if ((census[here + x] & kBalanceOutside) != 0) return best;
  for (int d = 0; d <= p.most; ++d) {
    const int other = x + sign * d;
    if (other < 0 || other >= p.across) break;
    if ((census[there + other] & kBalanceOutside) != 0) continue;
    const int difference = bitCount(census[here + x] ^ census[there + other]);
    if (difference < least) {
      best = d;
      least = difference;
    }
  }
  return best;
}

void main() {
  const int y = int(gl_WorkGroupID.x), lane = int(gl_LocalInvocationIndex);
  const int left = y * p.across, right = (p.down + y) * p.across;
  if (lane < 2 * kBalanceSums) totals[lane] = 0;
  barrier();

  uvec3 left_sums = uvec3(0), right_sums = uvec3(0);
  for (int x = lane; x < p.across; x += kBalanceGroup) {
    const int d = nearest(left, x, right, -1);
    if (d < 0 || nearest(right, x - d, left, 1) != d) continue;
    const uint l = cells[left + x], r = cells[right + x - d];
    if (min(l, r) < kBalanceDark || max(l, r) > kBalanceBright) continue;
    left_sums += uvec3(1, l, l * l);
    right_sums += uvec3(1, r, r * r);
  }
  left_sums = subgroupAdd(left_sums);
  right_sums = subgroupAdd(right_sums);
  if (subgroupElect())
    for (int i = 0; i < kBalanceSums; ++i) {
      atomicAdd(totals[i], left_sums[i]);
      atomicAdd(totals[kBalanceSums + i], right_sums[i]);
    }
  barrier();
  if (lane < 2 * kBalanceSums) rows[(lane / kBalanceSums * p.down + y) * kBalanceSums + lane % kBalanceSums] = totals[lane];
}
