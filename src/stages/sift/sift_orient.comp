#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "stages/sift/sift_params.h"
#include "stages/sift/sift_space.glsl"
#include "stages/sift/two_floats.glsl"

layout(std430, binding = 1) readonly buffer Planes { float planes[]; };
const int kMostSamples = 40;  // along a side: 4.5 scales of at most 3.6 px to both sides
#include "stages/sift/sift_samples.glsl"

// A workgroup a place: directions of the gradients around it. At most 1089 samples of four floats, about 120 operations and one
// atomic in shared memory each.
layout(local_size_x = kSiftLanes) in;
layout(std430, binding = 0) readonly buffer Windows { ivec4 windows[]; };
layout(std430, binding = 2) buffer Work { uint work[]; };
layout(push_constant) uniform Push { SiftPointPush p; };

const int kDirections = 36;
shared int histogram[kDirections];
shared int64_t smoothed[kDirections];

int64_t count_at(int i) { return histogram[(i + kDirections) % kDirections]; }

// Peaks of at least 0.8 of the highest, the first four.
void find_angles(int place) {
  int64_t highest = smoothed[0];
  for (int i = 1; i < kDirections; ++i) highest = max(highest, smoothed[i]);
  int angles = 0;
  for (int i = 0; i < kDirections && angles < kSiftMostAngles; ++i) {
    const int64_t before = smoothed[(i + kDirections - 1) % kDirections], here = smoothed[i],
                  after = smoothed[(i + 1) % kDirections];
    if (here <= before || here < after || 5 * here < 4 * highest) continue;
    precise const float half_rise = 0.5 * float(before - after);
    precise const float bin = float(i) + quotient(half_rise, float(before - 2 * here + after));
    precise float turns = quotient(bin, kDirections);
    if (turns < 0) turns += 1;
    work[place + 9 + angles++] = floatBitsToUint(turns);
  }
  work[place + 8] = angles;
}

void main() {
  const int lane = int(gl_LocalInvocationIndex), window = int(gl_WorkGroupID.y), i = int(gl_WorkGroupID.x);
  const SiftWork lists = sift_work(p.shape);
  const int first = window * lists.words;
  if (i >= int(work[first + 2])) return;
  const int place = first + lists.places + int(work[first + lists.kept + i]) * kSiftPlaceWords;
  const vec2 at = uintBitsToFloat(uvec2(work[place], work[place + 1]));
  const float scale = uintBitsToFloat(work[place + 2]);
  const int octave = int(work[place + 4]), level = int(work[place + 5]);

  if (lane < kDirections) histogram[lane] = 0;
  precise const float reach = 4.5 * scale;
  const ivec4 samples = samples_around(at, reach, size_of(part_of(p.shape, windows[window]), octave));
  weigh(lane, samples, at, product_of(1.5, scale));
  barrier();
  const Plane plane = plane_of(p.shape, window, octave, level);
  const int wide = samples.z - samples.x, count = wide * (samples.w - samples.y);
  for (int k = lane; k < count; k += kSiftLanes) {
    const ivec2 from = ivec2(k % wide, k / wide);
    const vec2 gradient = gradient_at(plane, samples.xy + from);
    precise const float direction = gradient.y * float(kDirections);
    atomicAdd(histogram[int(roundEven(direction)) % kDirections], int(roundEven(value_at(gradient.x, from.y, from.x))));
  }
  barrier();
  if (lane < kDirections)
    smoothed[lane] = count_at(lane - 2) + count_at(lane + 2) + 4 * (count_at(lane - 1) + count_at(lane + 1)) + 6 * count_at(lane);
  barrier();
  if (lane == 0) find_angles(place);
}
