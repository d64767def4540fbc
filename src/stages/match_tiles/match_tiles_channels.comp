#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#include "stages/match_tiles/match_tiles_params.h"

// The channels that match_tiles.comp compares, made once a picture. Moves 5 (left) or 9 bytes a pixel (right), one more where
// masked, in about 50 operations.
//   left:  gray | sobel_x << 8 | sobel_y << 16
//   right: gray | low x << 8 | high x << 16, low y | high y << 8
// Outside the raw pictures every channel has a value that is further than any truncation from all values of the other side.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer Picture { uint8_t picture[]; };
layout(std430, binding = 1) readonly buffer Inside { uint8_t inside[]; };
layout(std430, binding = 2) writeonly buffer Words { uint words[]; };
layout(push_constant) uniform Push { MatchChannelsPush p; };

const int kGroup = kGroupWidth * kGroupHeight;
const int kGrayWidth = kGroupWidth + 4, kGrayHeight = kGroupHeight + 4;    // two pixels around the workgroup
const int kSobelWidth = kGroupWidth + 2, kSobelHeight = kGroupHeight + 2;  // one pixel
shared int gray[kGrayHeight * kGrayWidth];
shared ivec2 sobel[kSobelHeight * kSobelWidth];

// Gray values are below 128, clipped gradients in 65 .. 191.
const uint kLeftOutside = 0xFFFFFF, kRightOutside = 191;  // right: gray; its gradients are 0

ivec2 clamped(ivec2 at) { return clamp(at, ivec2(0), ivec2(p.width, p.height) - 1); }
int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }

ivec2 sobel_at(int i) {
  const int up = i - kGrayWidth, down = i + kGrayWidth;
  const int across = gray[up + 1] + 2 * gray[i + 1] + gray[down + 1] - gray[up - 1] - 2 * gray[i - 1] - gray[down - 1];
  const int along = gray[down - 1] + 2 * gray[down] + gray[down + 1] - gray[up - 1] - 2 * gray[up] - gray[up + 1];
  return clamp(ivec2(across, along), -p.clip, p.clip) + 128;
}

bool outside(ivec2 at) {
  if (p.masked == 0) return false;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      if (uint(inside[index(p.inside, clamped(at + ivec2(dx, dy)))]) == 0) return true;
  return false;
}

void main() {
  const int me = int(gl_LocalInvocationIndex);
  const ivec2 corner = ivec2(gl_WorkGroupID.xy) * ivec2(kGroupWidth, kGroupHeight);
  for (int i = me; i < kGrayWidth * kGrayHeight; i += kGroup)
    gray[i] = int(picture[index(p.picture, clamped(corner - 2 + ivec2(i % kGrayWidth, i / kGrayWidth)))]);
  barrier();
  // Beyond the picture the gradients continue, not the gray values under them.
  for (int i = me; i < kSobelWidth * kSobelHeight; i += kGroup) {
    const ivec2 at = clamped(corner - 1 + ivec2(i % kSobelWidth, i / kSobelWidth)) - corner + 2;
    sobel[i] = sobel_at(at.y * kGrayWidth + at.x);
  }
  barrier();

  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  const ivec2 local = ivec2(gl_LocalInvocationID.xy);
  const uint half_gray = uint(gray[(local.y + 2) * kGrayWidth + local.x + 2]) >> 1;
  const int i = (local.y + 1) * kSobelWidth + local.x + 1, o = at.y * p.width + at.x;
  const ivec2 here = sobel[i];
  if (p.right == 0) {
    words[o] = outside(at) ? kLeftOutside : half_gray | uint(here.x) << 8 | uint(here.y) << 16;
    return;
  }
  const ivec2 before = (here + sobel[i - 1] + 1) / 2, after = (here + sobel[i + 1] + 1) / 2;
  const int above = (here.y + sobel[i - kSobelWidth].y + 1) / 2, below = (here.y + sobel[i + kSobelWidth].y + 1) / 2;
  const ivec2 low = min(here, min(before, after)), high = max(here, max(before, after));
  const int low_y = min(low.y, min(above, below)), high_y = max(high.y, max(above, below));
  const bool out_here = outside(at);
  words[2 * o] = out_here ? kRightOutside : half_gray | uint(low.x) << 8 | uint(high.x) << 16;
  words[2 * o + 1] = out_here ? 0 : uint(low_y) | uint(high_y) << 8;
}
