#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#include "stages/sift/sift_params.h"
#include "stages/sift/sift_space.glsl"

// Scale space, one level of one octave of all windows: blurs down, then along, and subtracts what it blurred. With radius r a tile
// reads (32 + 2 r)(16 + 2 r) floats and writes 1024; 6 r operations a pixel along and 6 r (1 + r / 16) down. Floats are added in
// the order of the reference, so that they have its bits.
layout(local_size_x = kSiftLanes) in;
layout(std430, binding = 0) readonly buffer Windows { ivec4 windows[]; };
layout(std430, binding = 1) readonly buffer Src { uint8_t src[]; };
layout(std430, binding = 2) buffer Planes { float planes[]; };
layout(push_constant) uniform Push { SiftBlurPush p; };

const int kWide = kSiftTileWidth + 2 * kSiftMostBlur, kHigh = kSiftTileHeight + 2 * kSiftMostBlur;
shared float tile[kHigh * kWide];
shared float columns[kSiftTileHeight * kWide];

Part part;

// A pixel of the level below: of the picture, of the octave below (every second pixel of its level 3), or of this octave.
float load(Plane from, ivec2 at) {
  if (p.level == 0) {
    at += part.corner;
    return float(uint(src[p.src.offset + at.y * p.src.stride + at.x]));
  }
  if (p.octave > 0 && p.level == 1) at *= 2;
  return planes[from.offset + at.y * from.stride + at.x];
}

void main() {
  const int lane = int(gl_LocalInvocationIndex), window = int(gl_WorkGroupID.y);
  part = part_of(p.shape, windows[window]);
  const ivec2 size = size_of(part, p.octave), room = room_of(p.shape, p.octave);
  const int tiles = (room.x + kSiftTileWidth - 1) / kSiftTileWidth, group = int(gl_WorkGroupID.x);
  const ivec2 corner = ivec2(group % tiles * kSiftTileWidth, group / tiles * kSiftTileHeight);
  if (corner.x >= size.x || corner.y >= size.y) return;

  const bool halves = p.octave > 0 && p.level == 1;
  const Plane from = plane_of(p.shape, window, halves ? p.octave - 1 : p.octave, halves ? kSiftLevels : max(p.level - 1, 0));
  const int r = p.radius, wide = kSiftTileWidth + 2 * r, high = kSiftTileHeight + 2 * r;
  for (int i = lane; i < wide * high; i += kSiftLanes) {
    const ivec2 at = ivec2(i % wide, i / wide);
    tile[at.y * kWide + at.x] = load(from, clamp(corner - r + at, ivec2(0), size - 1));
  }
  barrier();
  for (int i = lane; i < wide * kSiftTileHeight; i += kSiftLanes) {
    const int x = i % wide, y = i / wide, at = (y + r) * kWide + x;
    precise float sum = tile[at] * p.weight[0];
    for (int k = 1; k <= r; ++k) sum += (tile[at - k * kWide] + tile[at + k * kWide]) * p.weight[k];
    columns[y * kWide + x] = sum;
  }
  barrier();
  const Plane to = plane_of(p.shape, window, p.octave, p.level);
  const Plane difference = plane_of(p.shape, window, p.octave, kSiftBlurred + max(p.level - 1, 0));
  for (int i = lane; i < kSiftTileWidth * kSiftTileHeight; i += kSiftLanes) {
    const int x = i % kSiftTileWidth, y = i / kSiftTileWidth, at = y * kWide + x + r;
    const ivec2 place = corner + ivec2(x, y);
    if (place.x >= size.x || place.y >= size.y) continue;
    precise float sum = columns[at] * p.weight[0];
    for (int k = 1; k <= r; ++k) sum += (columns[at - k] + columns[at + k]) * p.weight[k];
    planes[to.offset + place.y * to.stride + place.x] = sum;
    if (p.level == 0) continue;
    precise const float rise = sum - tile[(y + r) * kWide + x + r];
    planes[difference.offset + place.y * difference.stride + place.x] = rise;
  }
}
