#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#include "stages/histogram/histogram_params.h"

// Moves up to 4 bytes a pixel of each area and the bins that are not empty, once a workgroup; about 20 operations a pixel and one
// atomic in shared memory where it counts.
layout(local_size_x = kAreaLanes) in;
layout(std430, binding = 0) readonly buffer Areas { DeviceArea areas[]; };
layout(std430, binding = 1) readonly buffer Hue { uint8_t hue[]; };
layout(std430, binding = 2) readonly buffer Saturation { uint8_t saturation[]; };
layout(std430, binding = 3) readonly buffer Value { uint8_t value[]; };
layout(std430, binding = 4) readonly buffer Marks { uint8_t marks[]; };
layout(std430, binding = 5) buffer Results { uint results[]; };  // kHistogramBins an area, 0 at first
layout(push_constant) uniform Push { HistogramPush p; };

shared uint bins[kHistogramBins];

int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }

bool counts(DeviceArea area, ivec2 at) {
  if (!in_disc(area, at) || int(value[index(p.value, at)]) < p.min_value) return false;
  return p.with_marks == 0 || (int(marks[index(p.marks, at)]) & area.bits) != 0;
}

void main() {
  const int lane = int(gl_LocalInvocationIndex);
  for (int i = lane; i < kHistogramBins; i += kAreaLanes) bins[i] = 0;
  barrier();
  const DeviceArea area = areas[gl_WorkGroupID.y];
  const ivec4 bounds = bounds_of(area, ivec2(p.width, p.height));
  const int wide = bounds.z - bounds.x, pixels = wide * (bounds.w - bounds.y);
  for (int i = int(gl_GlobalInvocationID.x); i < pixels; i += kAreaGroups * kAreaLanes) {
    const ivec2 at = bounds.xy + ivec2(i % wide, i / wide);
    if (!counts(area, at)) continue;
    const uint bin = (uint(hue[index(p.hue, at)]) >> 3) * 32 + (uint(saturation[index(p.saturation, at)]) >> 3);
    atomicAdd(bins[bin], 1);
  }
  barrier();
  for (int i = lane; i < kHistogramBins; i += kAreaLanes)
    if (bins[i] != 0) atomicAdd(results[int(gl_WorkGroupID.y) * kHistogramBins + i], bins[i]);
}
