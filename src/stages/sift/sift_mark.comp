#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/sift/sift_params.h"
#include "stages/sift/sift_space.glsl"

// Extrema of all levels, octaves and windows as a bit each. Reads a difference a position and, where that is large, its neighbours
// until one exceeds it, mostly from the cache; writes a claim and a bit a position. About 60 operations, most of them for the place.
layout(local_size_x = kSiftLanes) in;
layout(std430, binding = 0) readonly buffer Windows { ivec4 windows[]; };
layout(std430, binding = 1) readonly buffer Planes { float planes[]; };
layout(std430, binding = 2) writeonly buffer Claims { uint claims[]; };
layout(std430, binding = 3) writeonly buffer Work { uint work[]; };
layout(std430, binding = 4) writeonly buffer Groups { uint groups[]; };
layout(push_constant) uniform Push { SiftPointPush p; };

const uint kFree = 0xFFFFFFFFu;
const int kWords = kSiftLanes / 32;
shared uint bits[kWords];

// Whether it lies where this octave is searched: a pixel more than the window on each side, as its extremum may be refined to lie
// inside.
bool searched(Part part, Position position) {
  const ivec2 first = ((part.window.xy - part.corner) >> position.octave) - 1;
  const ivec2 end = ((part.window.zw - 1 - part.corner) >> position.octave) + 2;
  const ivec2 size = size_of(part, position.octave);
  return all(greaterThanEqual(position.at, max(first, ivec2(kSiftBorder)))) &&
         all(lessThan(position.at, min(end, size - kSiftBorder)));
}

bool is_extremum(int window, Position position) {
  const Plane here = plane_of(p.shape, window, position.octave, kSiftBlurred + position.level);
  const int plane = room_of(p.shape, position.octave).x * room_of(p.shape, position.octave).y;
  const int middle = here.offset + position.at.y * here.stride + position.at.x;
  const float value = planes[middle];
  if (!(abs(value) > p.least_difference)) return false;
  for (int level = -1; level <= 1; ++level)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const float other = planes[middle + level * plane + y * here.stride + x];
        if (value > 0 ? other > value : other < value) return false;
      }
  return true;
}

void main() {
  const int lane = int(gl_LocalInvocationIndex), index = int(gl_GlobalInvocationID.x), window = int(gl_WorkGroupID.y);
  if (index == 0 && window == 0)
    for (int i = 0; i < kSiftGroupWords; ++i) groups[i] = i % 3 == 0 ? 0 : i % 3 == 1 ? p.shape.windows : 1;
  if (lane < kWords) bits[lane] = 0;
  barrier();
  const int positions = positions_in(p.shape);
  if (index < positions) {
    const Position position = position_of(p.shape, index);
    const bool is = searched(part_of(p.shape, windows[window]), position) && is_extremum(window, position);
    claims[window * positions + index] = is ? 0 : kFree;
    if (is) atomicOr(bits[lane / 32], 1u << lane % 32);
  }
  barrier();
  const SiftWork lists = sift_work(p.shape);
  if (lane < kWords) work[window * lists.words + lists.bits + int(gl_WorkGroupID.x) * kWords + lane] = bits[lane];
}
