#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "stages/balance/balance_params.h"

// A workgroup a row, those of the left picture first. Moves 4 bytes a pixel (with inside pictures), 10 operations.
layout(local_size_x = kBalanceGroup) in;
layout(std430, binding = 0) readonly buffer Left { uint8_t left[]; };
layout(std430, binding = 1) readonly buffer Right { uint8_t right[]; };
layout(std430, binding = 2) readonly buffer LeftInside { uint8_t left_inside[]; };
layout(std430, binding = 3) readonly buffer RightInside { uint8_t right_inside[]; };
layout(std430, binding = 4) writeonly buffer Rows { uint rows[]; };  // [picture][y][kBalanceSums]
layout(push_constant) uniform Push { BalanceSumsPush p; };

shared uint totals[kBalanceSums];

int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }

void main() {
  const bool is_right = gl_WorkGroupID.y != 0;
  const int y = int(gl_WorkGroupID.x), lane = int(gl_LocalInvocationIndex);
  if (lane < kBalanceSums) totals[lane] = 0;
  barrier();

  uvec3 sums = uvec3(0);  // a row's fit 32 bits: see brightness_sums()
  for (int x = lane; x < p.width; x += kBalanceGroup) {
    const ivec2 at = ivec2(x, y);
    if (p.masked != 0 &&
        (is_right ? uint(right_inside[index(p.right_inside, at)]) : uint(left_inside[index(p.left_inside, at)])) == 0)
      continue;
    const uint v = is_right ? uint(right[index(p.right, at)]) : uint(left[index(p.left, at)]);
    sums += uvec3(1, v, v * v);
  }
  sums = subgroupAdd(sums);
  if (subgroupElect())
    for (int i = 0; i < kBalanceSums; ++i) atomicAdd(totals[i], sums[i]);
  barrier();
  if (lane < kBalanceSums) rows[(int(gl_WorkGroupID.y) * p.height + y) * kBalanceSums + lane] = totals[lane];
}
