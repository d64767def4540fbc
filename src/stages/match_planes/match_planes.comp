#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#include "stages/types/clear.h"
#include "stages/types/noise.h"
#include "stages/match_planes/match_planes_params.h"

// Two tiles: gray, then all values with a border of one pixel for the intervals. Moves 14 bytes a pixel (2 read with an inside
// picture, 12 written) and about 1.8 + 1.4 words into the tiles; about 130 operations.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer Gray { uint8_t gray[]; };
layout(std430, binding = 1) readonly buffer Inside { uint8_t inside[]; };
layout(std430, binding = 2) readonly buffer Noise { uint noise_q4; };
layout(std430, binding = 3) readonly buffer Clear { int known; };  // above 0: clear pictures
layout(std430, binding = 4) writeonly buffer Planes { uint planes[]; };
layout(push_constant) uniform Push { MatchPlanesPush p; };

const ivec2 kCensus[16] = {ivec2(-2, -2), ivec2(0, -2), ivec2(2, -2), ivec2(-1, -1), ivec2(1, -1), ivec2(-3, 0),
                           ivec2(-2, 0),  ivec2(-1, 0), ivec2(1, 0),  ivec2(2, 0),   ivec2(3, 0),  ivec2(-1, 1),
                           ivec2(1, 1),   ivec2(-2, 2), ivec2(0, 2),  ivec2(2, 2)};

const int kGroup = kGroupWidth * kGroupHeight;
const ivec2 kReach = ivec2(3, 2);  // of the census, and of a gradient beside the pixel
const int kTileWidth = kGroupWidth + 2 * 3, kTileHeight = kGroupHeight + 2 * 2;
const int kInnerWidth = kGroupWidth + 2, kInnerHeight = kGroupHeight + 2;
shared int tile[kTileHeight * kTileWidth];
shared uint values[kInnerHeight * kInnerWidth];  // as word 0

ivec2 clamped(ivec2 at) { return clamp(at, ivec2(0), ivec2(p.width, p.height) - 1); }
int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }

uint gradient(int sum) { return uint((known > 0 ? clamp(sum, -127, 127) : clamp(sum >> 2, -63, 63)) + 128); }

// The values of the pixel in the middle of a tile's 3x3.
uint values_at(int i) {
  const int diagonal = tile[i + kTileWidth + 1] - tile[i - kTileWidth - 1];
  const int other = tile[i + kTileWidth - 1] - tile[i - kTileWidth + 1];
  const uint x = gradient(diagonal - other + 2 * (tile[i + 1] - tile[i - 1]));
  const uint y = gradient(diagonal + other + 2 * (tile[i + kTileWidth] - tile[i - kTileWidth]));
  return uint(tile[i]) | x << 8 | y << 16;
}

uint census_at(int i) {
  uint bits = 0;
  const int least = tile[i] - census_dead_zone(int(noise_q4));
  for (int k = 0; k < 16; ++k)
    bits |= uint(tile[i + kCensus[k].y * kTileWidth + kCensus[k].x] < least) << k;
  return bits;
}

uint channel(uint word, int c) { return word >> 8 * c & 0xFF; }

void main() {
  const ivec2 corner = ivec2(gl_WorkGroupID.xy) * ivec2(kGroupWidth, kGroupHeight);
  const int lane = int(gl_LocalInvocationIndex);
  for (int i = lane; i < kTileWidth * kTileHeight; i += kGroup)
    tile[i] = int(gray[index(p.gray, clamped(corner - kReach + ivec2(i % kTileWidth, i / kTileWidth)))]);
  barrier();

  for (int i = lane; i < kInnerWidth * kInnerHeight; i += kGroup) {
    // Beyond the border the values themselves continue, not the gradients of a continued picture.
    const ivec2 at = clamped(corner - 1 + ivec2(i % kInnerWidth, i / kInnerWidth)), in_tile = at - corner + kReach;
    const bool outside = p.masked != 0 && uint(inside[index(p.inside, at)]) == 0;
    const int j = in_tile.y * kTileWidth + in_tile.x;
    values[i] = values_at(j) | (outside ? 0xFF000000u : 0);
  }
  barrier();

  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  const int i = (int(gl_LocalInvocationID.y) + 1) * kInnerWidth + int(gl_LocalInvocationID.x) + 1;
  const uint left = values[i - 1], right = values[i + 1], up = values[i - kInnerWidth], down = values[i + kInnerWidth];
  uint outside = values[i] | left | right | up | down;
  outside |= values[i - kInnerWidth - 1] | values[i - kInnerWidth + 1] | values[i + kInnerWidth - 1] | values[i + kInnerWidth + 1];
  const uint bits = census_at((int(gl_LocalInvocationID.y) + kReach.y) * kTileWidth + int(gl_LocalInvocationID.x) + kReach.x);
  uint low = bits << 24, high = (bits & 0xFF00) << 16;
  for (int c = 0; c < 3; ++c) {
    const uint v = channel(values[i], c);
    const uvec4 half_way = (v + uvec4(channel(left, c), channel(right, c), channel(up, c), channel(down, c)) + 1) >> 1;
    const int wider = c == 0 && known > 0 ? kClearGrayDeadZone : 0;
    const int least = int(min(min(min(half_way.x, half_way.y), min(half_way.z, half_way.w)), v)) - wider;
    const int most = int(max(max(max(half_way.x, half_way.y), max(half_way.z, half_way.w)), v)) + wider;
    low |= uint(max(least, 0)) << 8 * c;
    high |= uint(min(most, 255)) << 8 * c;
  }
  const int out_at = index(p.planes, at), next = p.planes.stride * p.height;
  planes[out_at] = (values[i] & 0xFFFFFF) | (outside & 0xFF000000);
  planes[out_at + next] = low;
  planes[out_at + 2 * next] = high;
}
