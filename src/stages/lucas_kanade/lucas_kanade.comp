#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/lucas_kanade/lucas_kanade_params.h"

// Taps of a tile and what surrounds it are worked out once. Moves 4 bytes a pixel; about 600 operations, most of them sums.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer Left { uint8_t left[]; };
layout(std430, binding = 1) readonly buffer Right { uint8_t right[]; };
layout(std430, binding = 2) readonly buffer D { uint16_t d_q4[]; };
layout(std430, binding = 3) readonly buffer Clear { int clear; };  // above 0: nothing changes
layout(std430, binding = 4) writeonly buffer Dst { uint16_t dst[]; };
layout(push_constant) uniform Push { LucasKanadePush p; };

const int kNone = 0xFFFF;
const int kReach = kLucasKanadeReach;
const int kTileWidth = kGroupWidth / 2 + 2 * kReach, kTileHeight = kGroupHeight / 2 + 2 * kReach;
shared ivec2 tile[kTileHeight * kTileWidth];  // pull, weight

int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }
int left_at(ivec2 at) { return int(left[index(p.left, at)]); }
int right_at(int x, int y) { return int(right[index(p.right, ivec2(x, y))]); }

ivec2 tap(ivec2 at) {
  if (at.x < 1 || at.x + 1 >= p.width || at.y < 0 || at.y >= p.height) return ivec2(0);
  const int d = int(d_q4[index(p.d_q4, at)]), at_q4 = 16 * at.x - d, r = at_q4 >> 4, f = at_q4 & 15;
  if (d == kNone || r < 1 || r + 2 >= p.width) return ivec2(0);
  const int before = right_at(r - 1, at.y), here = right_at(r, at.y), after = right_at(r + 1, at.y),
            beyond = right_at(r + 2, at.y);
  const int e = 16 * left_at(at) - (here * (16 - f) + after * f);
  if (abs(e) >= 16 * kLucasKanadeMostDifference) return ivec2(0);
  const int l_q1 = left_at(at + ivec2(1, 0)) - left_at(at - ivec2(1, 0)), r_q5 = (after - before) * (16 - f) + (beyond - here) * f;
  const int g_q2 = (16 * l_q1 + r_q5 + 8) >> 4, size = abs(g_q2);
  const int weight = lucas_kanade_weight(max(l_q1 * r_q5, 0) >> 2, lucas_kanade_inverse(size));
  return ivec2((g_q2 < 0 ? -e : e) * lucas_kanade_pull(size), weight);
}

int step_q4(int centre) {
  ivec2 sum = ivec2(0);
  for (int v = -kReach; v <= kReach; ++v)
    for (int u = -kReach; u <= kReach; ++u) sum += tile[centre + v * kTileWidth + u];
  if (sum.y == 0) return 0;
  const int size = min(kLucasKanadeMost_q4, (2 * abs(sum.x) / sum.y + 1) / 2);
  return sum.x > 0 ? -size : size;
}

void main() {
  const ivec2 corner = ivec2(gl_WorkGroupID.xy) * ivec2(kGroupWidth, kGroupHeight) / 2 - kReach;
  for (int i = int(gl_LocalInvocationIndex); i < kTileWidth * kTileHeight; i += kGroupWidth * kGroupHeight)
    tile[i] = tap(2 * (corner + ivec2(i % kTileWidth, i / kTileWidth)));
  barrier();

  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  const ivec2 in_tile = ivec2(gl_LocalInvocationID.xy) / 2 + kReach;
  const int centre = in_tile.y * kTileWidth + in_tile.x;
  int d = int(d_q4[index(p.d_q4, at)]);
  if (d != kNone && clear <= 0) d = clamp(d + step_q4(centre), 0, p.most_q4);
  dst[index(p.dst, at)] = uint16_t(d);
}
