#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/match_around/match_around_params.h"

layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer Left { uint8_t left[]; };
layout(std430, binding = 1) readonly buffer Right { uint8_t right[]; };
layout(std430, binding = 2) readonly buffer LeftInside { uint8_t left_inside[]; };
layout(std430, binding = 3) readonly buffer RightInside { uint8_t right_inside[]; };
layout(std430, binding = 4) readonly buffer Coarser { int16_t coarser[]; };
layout(std430, binding = 5) writeonly buffer Dst { int16_t dst[]; };
layout(push_constant) uniform Push { MatchAroundPush p; };

const int kReach = 3;  // 7x7 window
const int kTileWidth = kGroupWidth + 2 * kReach, kTileHeight = kGroupHeight + 2 * kReach;
const int kOutside = -1;
// Left pixels under the windows of this workgroup; the right ones differ from pixel to pixel and come from the cache.
shared int tile[kTileHeight * kTileWidth];

int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }
ivec2 clamped(ivec2 at) { return clamp(at, ivec2(0), ivec2(p.width, p.height) - 1); }

int load_left(ivec2 at) {
  at = clamped(at);
  if (p.masked != 0 && uint(left_inside[index(p.left_inside, at)]) == 0) return kOutside;
  return int(left[index(p.left, at)]);
}
int load_right(ivec2 at) { return int(right[index(p.right, clamped(at))]); }
bool right_is_outside(ivec2 at) { return p.masked != 0 && uint(right_inside[index(p.right_inside, clamped(at))]) == 0; }

int window_cost(ivec2 at, int d) {
  int sum = 0;
  for (int dy = -kReach; dy <= kReach; ++dy) {
    const int tile_row = (int(gl_LocalInvocationID.y) + kReach + dy) * kTileWidth + int(gl_LocalInvocationID.x) + kReach;
    ivec2 r_at = at + ivec2(-kReach - d, dy);
    int before = load_right(r_at - ivec2(1, 0)), r = load_right(r_at);
    for (int dx = -kReach; dx <= kReach; ++dx) {
      const int after = load_right(r_at + ivec2(1, 0));
      const int l = tile[tile_row + dx];
      const int best = min(abs(l - r), min(abs(l - (r + before + 1) / 2), abs(l - (r + after + 1) / 2)));
      sum += l == kOutside || right_is_outside(r_at) ? 255 : best;
      before = r;
      r = after;
      ++r_at.x;
    }
  }
  return sum;
}

void main() {
  const ivec2 corner = ivec2(gl_WorkGroupID.xy) * ivec2(kGroupWidth, kGroupHeight) - kReach;
  for (int i = int(gl_LocalInvocationIndex); i < kTileWidth * kTileHeight; i += kGroupWidth * kGroupHeight)
    tile[i] = load_left(corner + ivec2(i % kTileWidth, i / kTileWidth));
  barrier();

  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  int first = at.x - (p.width - 1), last = at.x;
  if (p.whole_row == 0) {
    const int centre = 2 * int(coarser[index(p.coarser, at / 2)]);
    first = centre - p.radius;
    last = centre + p.radius;
  }
  int best = first, best_cost = window_cost(at, first);
  for (int d = first + 1; d <= last; ++d) {
    const int cost = window_cost(at, d);
    if (cost < best_cost) {
      best = d;
      best_cost = cost;
    }
  }
  dst[index(p.dst, at)] = int16_t(best);
}
