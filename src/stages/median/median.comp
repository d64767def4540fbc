#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/median/median_params.h"

// Moves 2 or 4 bytes a pixel (with the tile's margin 1.4 pixels are read, mostly from the cache); 3 sorted columns of 6 operations
// and 12 to join them.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(constant_id = 0) const int kPixelBytes = 1;
// The same two buffers, seen as the pixel type that kPixelBytes selects.
layout(std430, binding = 0) readonly buffer Src8 { uint8_t src8[]; };
layout(std430, binding = 0) readonly buffer Src16 { uint16_t src16[]; };
layout(std430, binding = 1) writeonly buffer Dst8 { uint8_t dst8[]; };
layout(std430, binding = 1) writeonly buffer Dst16 { uint16_t dst16[]; };
layout(push_constant) uniform Push { MedianPush p; };

const int kTileWidth = kGroupWidth + 2, kTileHeight = kGroupHeight + 2;
shared uint tile[kTileHeight * kTileWidth];

uint load(ivec2 at) {
  at = clamp(at, ivec2(0), ivec2(p.width, p.height) - 1);
  const int i = p.src.offset + at.y * p.src.stride + at.x;
  return kPixelBytes == 1 ? uint(src8[i]) : uint(src16[i]);
}

uint middle(uint a, uint b, uint c) { return max(min(a, b), min(max(a, b), c)); }

// Low, middle and high of three pixels one above the other.
uvec3 sorted_column(int i) {
  const uint a = tile[i], b = tile[i + kTileWidth], c = tile[i + 2 * kTileWidth];
  const uint lo = min(a, b), hi = max(a, b);
  return uvec3(min(lo, c), max(lo, min(hi, c)), max(hi, c));
}

void main() {
  const ivec2 corner = ivec2(gl_WorkGroupID.xy) * ivec2(kGroupWidth, kGroupHeight) - 1;
  for (int i = int(gl_LocalInvocationIndex); i < kTileWidth * kTileHeight; i += kGroupWidth * kGroupHeight)
    tile[i] = load(corner + ivec2(i % kTileWidth, i / kTileWidth));
  barrier();

  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  const int i = int(gl_LocalInvocationID.y) * kTileWidth + int(gl_LocalInvocationID.x);
  const uvec3 a = sorted_column(i), b = sorted_column(i + 1), c = sorted_column(i + 2);
  const uint median = middle(max(max(a.x, b.x), c.x), middle(a.y, b.y, c.y), min(min(a.z, b.z), c.z));
  const int out_at = p.dst.offset + at.y * p.dst.stride + at.x;
  if (kPixelBytes == 1)
    dst8[out_at] = uint8_t(median);
  else
    dst16[out_at] = uint16_t(median);
}
