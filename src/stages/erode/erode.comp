#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#include "stages/erode/erode_params.h"

// Moves 2 W H bytes and the tiles' borders (1.4 times W H are read); 8 ands a pixel.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer Src { uint8_t src[]; };
layout(std430, binding = 1) writeonly buffer Dst { uint8_t dst[]; };
layout(push_constant) uniform Push { ErodePush p; };

const int kTileWidth = kGroupWidth + 2, kTileHeight = kGroupHeight + 2;
shared uint tile[kTileHeight * kTileWidth];

uint load(ivec2 at) {
  at = clamp(at, ivec2(0), ivec2(p.width, p.height) - 1);
  return uint(src[p.src.offset + at.y * p.src.stride + at.x]);
}

void main() {
  const ivec2 corner = ivec2(gl_WorkGroupID.xy) * ivec2(kGroupWidth, kGroupHeight) - 1;
  for (int i = int(gl_LocalInvocationIndex); i < kTileWidth * kTileHeight; i += kGroupWidth * kGroupHeight)
    tile[i] = load(corner + ivec2(i % kTileWidth, i / kTileWidth));
  barrier();

  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  const int up = int(gl_LocalInvocationID.y) * kTileWidth + int(gl_LocalInvocationID.x) + 1;
  const int here = up + kTileWidth, down = here + kTileWidth;
  uint all = tile[here] & tile[up] & tile[down] & tile[here - 1] & tile[here + 1];
  if (p.diagonal != 0) all &= tile[up - 1] & tile[up + 1] & tile[down - 1] & tile[down + 1];
  dst[p.dst.offset + at.y * p.dst.stride + at.x] = uint8_t(all);
}
