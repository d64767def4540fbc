#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/match_around/match_around_params.h"

// The four pixels of a block share their candidates, and their 7x7 windows lie in one 8x8 patch: 64 pixel costs for four windows
// instead of 196. Five candidates at once share what they read of the right picture: 26 bytes for 40 pixel costs.
// A block and candidate: 64 costs of 10 operations, and 4 each for what is read, about 900 in all; 42 reads from the cache, 13
// from shared memory. 640x480 with +-12: 76800 blocks * 25 candidates = 1.7 G operations; memory 5 bytes a pixel.
// Where blocks are few, several invocations share one, each with a part of its candidates.
layout(local_size_x = kAroundGroup) in;
layout(std430, binding = 0) readonly buffer Left { uint8_t left[]; };
layout(std430, binding = 1) readonly buffer Right { uint8_t right[]; };
layout(std430, binding = 2) readonly buffer LeftInside { uint8_t left_inside[]; };
layout(std430, binding = 3) readonly buffer RightInside { uint8_t right_inside[]; };
layout(std430, binding = 4) readonly buffer Coarser { int16_t coarser[]; };
layout(std430, binding = 5) writeonly buffer Dst { int16_t dst[]; };
layout(push_constant) uniform Push { MatchAroundPush p; };

const int kReach = 3, kPatch = 2 + 2 * kReach;
const int kCandidates = kAroundCandidates;
const int kSpan = kPatch + kCandidates - 1;  // right pixels that one row of the patch meets
const int kOutsideCost = 255;
const int kMaxBlocksY = kAroundGroup / kAroundBlocksX;
// Left pixels under the windows of this workgroup, 0x100 added where inside the raw picture.
shared int tile[(2 * kAroundBlocksX + 2 * kReach) * (2 * kMaxBlocksY + 2 * kReach)];
// Of each block's four pixels: cost << 16 | candidate. The least has the smallest d of equals, in whatever order parts come.
shared uint best[4 * kAroundGroup];

int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }
ivec2 clamped(ivec2 at) { return clamp(at, ivec2(0), ivec2(p.width, p.height) - 1); }

int load_left(ivec2 at) {
  at = clamped(at);
  return p.masked != 0 && uint(left_inside[index(p.left_inside, at)]) == 0 ? 0 : int(left[index(p.left, at)]) | 0x100;
}

// Window sums of kCandidates candidates, those of the left column of the block in the low halves: 49 * 255 fits 16 bits.
struct Sums {
  uint upper[kCandidates], lower[kCandidates];
};

// Adds one row of the patch. `u`: column of the right picture that its first pixel meets at the last candidate.
void add_row(int row, int tile_at, int y, int u, inout Sums sums) {
  int r[kSpan + 2], half_way[kSpan + 1], least[kSpan];
  const int right_row = p.right.offset + y * p.right.stride, inside_row = p.right_inside.offset + y * p.right_inside.stride;
  [[unroll]] for (int k = 0; k < kSpan + 2; ++k) r[k] = int(right[right_row + clamp(u + k - 1, 0, p.width - 1)]);
  [[unroll]] for (int k = 0; k < kSpan + 1; ++k) half_way[k] = (r[k] + r[k + 1] + 1) >> 1;
  [[unroll]] for (int k = 0; k < kSpan; ++k)
    least[k] = p.masked != 0 && uint(right_inside[inside_row + clamp(u + k, 0, p.width - 1)]) == 0 ? kOutsideCost : 0;
  int l[kPatch], counts[kPatch];
  [[unroll]] for (int i = 0; i < kPatch; ++i) {
    l[i] = tile[tile_at + i] & 0xFF;
    counts[i] = tile[tile_at + i] >> 8;
  }
  [[unroll]] for (int c = 0; c < kCandidates; ++c) {
    int costs[kPatch];
    [[unroll]] for (int i = 0; i < kPatch; ++i) {
      const int k = i + kCandidates - 1 - c;
      const int cost = min(abs(l[i] - r[k + 1]), min(abs(l[i] - half_way[k]), abs(l[i] - half_way[k + 1])));
      // A left pixel outside costs the same at every candidate: nothing will do.
      costs[i] = max(cost, least[k]) * counts[i];
    }
    int shared_by_both = 0;
    [[unroll]] for (int i = 1; i < kPatch - 1; ++i) shared_by_both += costs[i];
    const uint both = uint(shared_by_both + costs[0]) | uint(shared_by_both + costs[kPatch - 1]) << 16;
    if (row < kPatch - 1) sums.upper[c] += both;
    if (row > 0) sums.lower[c] += both;
  }
}

void main() {
  const int me = int(gl_LocalInvocationIndex);
  const int blocks = p.blocks_x * p.blocks_y, block = me % blocks, part = me / blocks;
  const ivec2 group = ivec2(p.blocks_x, p.blocks_y), corner = 2 * ivec2(gl_WorkGroupID.xy) * group;
  const ivec2 tile_size = 2 * group + 2 * kReach;
  for (int i = me; i < tile_size.x * tile_size.y; i += kAroundGroup)
    tile[i] = load_left(corner - kReach + ivec2(i % tile_size.x, i / tile_size.x));
  for (int i = 0; i < 4; ++i) best[i * kAroundGroup + me] = 0xFFFFFFFF;
  barrier();

  const ivec2 local = 2 * ivec2(block % p.blocks_x, block / p.blocks_x), at = corner + local;
  const bool in_picture = at.x < p.width && at.y < p.height;
  int first = at.x - (p.width - 1), last = at.x + 1;
  if (p.whole_row == 0 && in_picture) {
    const int centre = 2 * int(coarser[index(p.coarser, at / 2)]);
    first = centre - p.radius;
    last = centre + p.radius;
  }
  uint least[4] = {0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF};
  for (int d = first + part * kCandidates; in_picture && d <= last; d += p.parts * kCandidates) {
    Sums sums;
    [[unroll]] for (int c = 0; c < kCandidates; ++c) sums.upper[c] = sums.lower[c] = 0;
    for (int row = 0; row < kPatch; ++row)
      add_row(row, (local.y + row) * tile_size.x + local.x, clamp(at.y - kReach + row, 0, p.height - 1),
              at.x - kReach - (d + kCandidates - 1), sums);
    [[unroll]] for (int c = 0; c < kCandidates; ++c) {
      const uint candidate = uint(d + c - first);
      // Along a whole row the block's right column starts and ends one candidate later.
      const bool tried_left = d + c <= last - p.whole_row, tried_right = d + c <= last && d + c >= first + p.whole_row;
      if (tried_left) {
        least[0] = min(least[0], sums.upper[c] << 16 | candidate);
        least[2] = min(least[2], sums.lower[c] << 16 | candidate);
      }
      if (tried_right) {
        least[1] = min(least[1], (sums.upper[c] & 0xFFFF0000) | candidate);
        least[3] = min(least[3], (sums.lower[c] & 0xFFFF0000) | candidate);
      }
    }
  }
  for (int i = 0; i < 4; ++i) atomicMin(best[4 * block + i], least[i]);
  barrier();

  if (part != 0) return;
  for (int i = 0; i < 4; ++i) {
    const ivec2 pixel = at + ivec2(i & 1, i >> 1);
    if (pixel.x < p.width && pixel.y < p.height) dst[index(p.dst, pixel)] = int16_t(first + int(best[4 * block + i] & 0xFFFF));
  }
}
