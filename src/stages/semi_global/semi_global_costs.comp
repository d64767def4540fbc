#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/semi_global/semi_global_params.h"

// Costs C(x, d) of all pixels, as bytes [y][x][d], d filled up with 255 to a multiple of four. An invocation walks along a row with
// one word of disparities, so that of the four right pixels it compares with only one is new in each step. The word behind the last
// one is the least P2 of all paths.
// For W x H x D cells: writes W H D bytes, reads 24 bytes for four cells, nearly all from the cache; 40 operations a cell.
layout(local_size_x = kCostGroup) in;
layout(std430, binding = 0) readonly buffer Left { uint left_planes[]; };
layout(std430, binding = 1) readonly buffer Right { uint right_planes[]; };
layout(std430, binding = 2) writeonly buffer Costs { uint costs[]; };
layout(std430, binding = 3) readonly buffer Clear { int known; };  // above 0: clear pictures
layout(push_constant) uniform Push { SemiGlobalCostsPush p; };

struct Pixel {
  ivec3 value, low, high;
  uint census;
  bool outside;
};

Pixel unpack(uvec3 words) {
  const ivec3 shift = ivec3(0, 8, 16);
  return Pixel(ivec3(words.xxx >> shift & 0xFF), ivec3(words.yyy >> shift & 0xFF), ivec3(words.zzz >> shift & 0xFF),
               words.y >> 24 | words.z >> 24 << 8, words.x >> 24 != 0);
}

Pixel left_pixel(int y, int x) {
  const int i = p.left.offset + y * p.left.stride + x, next = p.left.stride * p.height;
  return unpack(uvec3(left_planes[i], left_planes[i + next], left_planes[i + 2 * next]));
}

Pixel right_pixel(int y, int x) {
  const int i = p.right.offset + y * p.right.stride + max(x, 0), next = p.right.stride * p.height;
  return unpack(uvec3(right_planes[i], right_planes[i + next], right_planes[i + 2 * next]));
}

uint cost(Pixel l, Pixel r) {
  const ivec3 to_right = max(l.value - r.high, r.low - l.value), to_left = max(r.value - l.high, l.low - r.value);
  const ivec3 apart = clamp(min(max(to_right, 0), max(to_left, 0)), 0, p.most);
  const int census = min(bitCount(l.census ^ r.census), p.census_most);
  return uint(l.outside || r.outside ? p.census_most + 3 * p.most : census + apart.x + apart.y + apart.z);
}

void main() {
  const int y = int(gl_WorkGroupID.y), i = int(gl_GlobalInvocationID.x);
  const int word = i % p.words, first = i / p.words * kCostRun, d = 4 * word;
  if (first >= p.width) return;
  if (y == 0 && i == 0)
    costs[p.height * p.width * p.words] = p.p2_least_unclear != p.p2_least && known <= 0 ? uint(p.p2_least_unclear) : uint(p.p2_least);
  Pixel r0, r1 = right_pixel(y, first - d - 1), r2 = right_pixel(y, first - d - 2), r3 = right_pixel(y, first - d - 3);
  for (int x = first; x < min(first + kCostRun, p.width); ++x) {
    const Pixel l = left_pixel(y, x);
    r0 = right_pixel(y, x - d);
    const uvec4 four = uvec4(cost(l, r0), cost(l, r1), cost(l, r2), cost(l, r3));
    const uvec4 bytes = mix(four, uvec4(255), greaterThanEqual(d + ivec4(0, 1, 2, 3), ivec4(p.max_disparity)));
    costs[(y * p.width + x) * p.words + word] = bytes.x | bytes.y << 8 | bytes.z << 16 | bytes.w << 24;
    r3 = r2;
    r2 = r1;
    r1 = r0;
  }
}
