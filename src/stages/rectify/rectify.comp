#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/rectify/rectify_params.h"

// Moves 9 bytes a gray pixel (map 6, source 1, as four neighbours share their reads in the cache, results 2) in 17 operations,
// 12 bytes a colour one in 45.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(constant_id = 0) const int kChannels = 1;  // bytes of a pixel
layout(std430, binding = 0) readonly buffer Src { uint8_t src[]; };
layout(std430, binding = 1) readonly buffer Corner { uint corner[]; };
layout(std430, binding = 2) readonly buffer Fraction { uint16_t fraction_q8[]; };
layout(std430, binding = 3) writeonly buffer Dst { uint8_t dst[]; };
layout(std430, binding = 4) writeonly buffer Inside { uint8_t inside[]; };
layout(push_constant) uniform Push { RectifyPush p; };

const uint kOutside = 0xFFFFFFFF;
const int kLinear = 0, kCubic = 1;  // ResampleMap::Columns

int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }

// The blend of four pixels whose upper left one has this channel at byte i.
uint blend(int i, uint fx, uint fy) {
  const int below = i + kChannels * p.src.stride;
  const uint top = uint(src[i]) * (256 - fx) + uint(src[i + kChannels]) * fx;
  const uint bottom = uint(src[below]) * (256 - fx) + uint(src[below + kChannels]) * fx;
  return (top * (256 - fy) + bottom * fy + 32768) >> 16;
}

ivec4 cubic_weights(int f) {
  const int f2 = f * f, f3 = f2 * f, half_unit = 1 << 16;
  const int before = (-f3 + 512 * f2 - 65536 * f + half_unit) >> 17, after = (-3 * f3 + 1024 * f2 + 65536 * f + half_unit) >> 17;
  const int last = (f3 - 256 * f2 + half_unit) >> 17;
  return ivec4(before, 256 - before - after - last, after, last);
}

ivec4 soft_weights(int f) {
  const int whole = f * (256 - f) >> 2, beside = (10 * whole * whole + (1 << 23)) >> 24;
  return ivec4(beside, 256 - 2 * beside, beside, 0);
}

// Of this channel at byte i of the raw picture, which is in row y.
uint four_rows(int i, int y, int fx, ivec4 weights) {
  int sum = 0;
  for (int k = 0; k < 4; ++k) {
    const int at = i + kChannels * p.src.stride * (clamp(y + k - 1, 0, p.src_height - 1) - y);
    sum += weights[k] * (int(src[at]) * (256 - fx) + int(src[at + kChannels]) * fx);
  }
  return uint(clamp((sum + 32768) >> 16, 0, 255));
}

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  const uint from = corner[index(p.corner, at)];
  const bool seen = from != kOutside;
  const int o = kChannels * index(p.dst, at);
  if (seen) {
    const int i = kChannels * index(p.src, ivec2(from >> 16, from & 0xFFFF));
    const uint fraction = uint(fraction_q8[index(p.fraction, at)]);
    if (p.columns == kLinear) {
      for (int c = 0; c < kChannels; ++c) dst[o + c] = uint8_t(blend(i + c, fraction >> 8, fraction & 0xFF));
    } else {
      const int f = int(fraction & 0xFF);
      const ivec4 weights = p.columns == kCubic ? cubic_weights(f) : soft_weights(f);
      for (int c = 0; c < kChannels; ++c)
        dst[o + c] = uint8_t(four_rows(i + c, int(from & 0xFFFF), int(fraction >> 8), weights));
    }
  } else {
    for (int c = 0; c < kChannels; ++c) dst[o + c] = uint8_t(0);
  }
  if (p.marks_inside != 0) inside[index(p.inside, at)] = uint8_t(seen ? 255 : 0);
}
