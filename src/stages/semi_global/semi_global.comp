#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_16bit_storage : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "stages/semi_global/semi_global_params.h"

// The paths from the right, and with them the winners: a subgroup walks back along a row, adds its path to the sums of all others,
// which it does not store, and picks both views' winners. What the right pixel x - d has found goes down through the disparities
// as x falls, and is complete at d = 0; there, of equals, the one with the smallest d has come last.
// For W x H x D cells and V volumes: reads (1 + V) W H D bytes, writes 6 bytes a pixel; 25 + 3 V operations a cell.
layout(local_size_x = kPathGroup) in;
layout(constant_id = 1) const int kVolumes = 1;
layout(std430, binding = 0) readonly buffer Costs { uint costs[]; };
layout(std430, binding = 1) readonly buffer Left { uint left_planes[]; };
layout(std430, binding = 2) readonly buffer Volume0 { uint volume_0[]; };
layout(std430, binding = 3) readonly buffer Volume1 { uint volume_1[]; };
layout(std430, binding = 4) readonly buffer Volume2 { uint volume_2[]; };
layout(std430, binding = 5) readonly buffer Volume3 { uint volume_3[]; };
layout(std430, binding = 6) writeonly buffer Found { uint found[]; };  // [y][x]: d, S(d - 1) - S(d), S(d + 1) - S(d), margin
layout(std430, binding = 7) writeonly buffer RightWinner { int16_t right_winner[]; };
layout(push_constant) uniform Push { SemiGlobalPush p; };
#include "stages/semi_global/semi_global_path.glsl"

const uint kNone = 0xFFFFFFFF;

// Read a pixel ahead of where they are used.
uint cost_ahead[kWords];
uint sums_ahead[kVolumes * kWords];
int gray_ahead;

uint sums[kVolumes * kWords];  // of the pixel reached
uvec4 keys[kWords];         // S << 16 | d of the left pixel
uvec4 right_least[kWords];  // the least key so far of the right pixel x - d

uint volume_word(int v, int i) {
  return v == 0 ? volume_0[i] : v == 1 ? volume_1[i] : v == 2 ? volume_2[i] : volume_3[i];
}

void load(int y, int x) {
  gray_ahead = int(left_planes[p.left.offset + y * p.left.stride + x] & 0xFF);
  for (int k = 0; k < kWords; ++k) {
    const bool there = word_of(k) < p.words;
    const int i = (y * p.width + x) * p.words + word_of(k);
    cost_ahead[k] = there ? costs[i] : kNone;
    for (int v = 0; v < kVolumes; ++v) sums_ahead[v * kWords + k] = there ? volume_word(v, i) : kNone;
  }
}

// Keys of the pixel from its path costs and the sums of the others.
void total() {
  for (int k = 0; k < kWords; ++k) {
    uvec4 s = path[k];
    for (int v = 0; v < kVolumes; ++v) s += unpack(sums[v * kWords + k]);
    keys[k] = word_of(k) < p.words ? min(s, kMost) << 16 | uint(4 * word_of(k)) + uvec4(0, 1, 2, 3) : uvec4(kNone);
  }
}

// Moves on what the right pixels have found by one disparity, and offers them the keys; returns the winner of right pixel x.
int offer_to_right() {
  const uint lane = gl_SubgroupInvocationID, end = gl_SubgroupSize - 1, after = (lane + 1) & end;
  uint upper = subgroupShuffle(right_least[0].x, after);
  for (int k = 0; k < kWords; ++k) {
    const uint upper_wrapped = k + 1 < kWords ? subgroupShuffle(right_least[min(k + 1, kWords - 1)].x, after) : kNone;
    right_least[k] = min(uvec4(right_least[k].yzw, lane == end ? upper_wrapped : upper), keys[k]);
    upper = upper_wrapped;
  }
  return int(right_least[0].x & 0xFFFF);  // of lane 0
}

// The left winner and what surrounds it.
uint pick() {
  uint least_key = kNone;
  for (int k = 0; k < kWords; ++k)
    least_key = min(least_key, min(min(keys[k].x, keys[k].y), min(keys[k].z, keys[k].w)));
  least_key = subgroupMin(least_key);
  const uint d = least_key & 0xFFFF, s = least_key >> 16;
  uint beside = 0, second = kMost;
  for (int k = 0; k < kWords; ++k) {
    const ivec4 apart = 4 * word_of(k) + ivec4(0, 1, 2, 3) - int(d);
    const uvec4 others = min(keys[k] >> 16, kMost);
    const uvec4 before = mix(uvec4(0), others, equal(apart, ivec4(-1))), behind = mix(uvec4(0), others, equal(apart, ivec4(1)));
    beside |= before.x | before.y | before.z | before.w | (behind.x | behind.y | behind.z | behind.w) << 8;
    const uvec4 far = mix(uvec4(kMost), others, greaterThan(abs(apart), ivec4(1)));
    second = min(second, min(min(far.x, far.y), min(far.z, far.w)));
  }
  beside = subgroupOr(beside);
  // At an end of the range one of them is not there; the differences then wrap, and nobody looks at them.
  const uint lower = (beside & 0xFF) - s, upper = (beside >> 8) - s;
  const uint margin = p.wants_margin != 0 ? subgroupMin(second) - s : 0;
  return d | (lower & 0xFF) << 8 | (upper & 0xFF) << 16 | margin << 24;
}

void walk(int y) {
  const int p2_least = int(costs[p.height * p.width * p.words]);
  begin_path();
  for (int k = 0; k < kWords; ++k) right_least[k] = uvec4(kNone);
  load(y, p.width - 1);
  int gray_before = gray_ahead;
  for (int x = p.width - 1; x >= 0; --x) {
    const int gray_here = gray_ahead;
    for (int k = 0; k < kWords; ++k) cost[k] = cost_ahead[k];
    for (int i = 0; i < kVolumes * kWords; ++i) sums[i] = sums_ahead[i];
    if (x > 0) load(y, x - 1);
    const int p2 = max(p2_least, p.p2 * p.p2_gradient / (p.p2_gradient + abs(gray_here - gray_before)));
    advance(uint(p.p1), uint(p2));
    total();
    const int right = offer_to_right();
    const uint left = pick();
    if (gl_SubgroupInvocationID == 0) {
      found[y * p.width + x] = left;
      right_winner[p.right_winner.offset + y * p.right_winner.stride + x] = int16_t(right);
    }
    gray_before = gray_here;
  }
}

void main() {
  const int stride = int(gl_NumWorkGroups.x * gl_NumSubgroups);
  for (int y = int(gl_WorkGroupID.x * gl_NumSubgroups + gl_SubgroupID); y < p.height; y += stride) walk(y);
}
