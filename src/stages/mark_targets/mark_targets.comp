#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#include "stages/mark_targets/mark_targets_params.h"

// Moves 4 W H bytes; 10 operations a pixel for each window that it lies in. The targets are the same for all invocations and stay
// in the cache.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer Wanted { MarkTarget targets[kMarkTargets]; };
layout(std430, binding = 1) readonly buffer Hue { uint8_t hue[]; };
layout(std430, binding = 2) readonly buffer Saturation { uint8_t saturation[]; };
layout(std430, binding = 3) readonly buffer Value { uint8_t value[]; };
layout(std430, binding = 4) writeonly buffer Marks { uint8_t marks[]; };
layout(push_constant) uniform Push { MarkTargetsPush p; };

int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }

bool fits(MarkTarget target, ivec3 hsv) {
  if (hsv.y < target.min_saturation || hsv.z < target.min_value) return false;
  const int around = (hsv.x - target.hue) & 255;
  return min(around, 256 - around) <= target.hue_tolerance;
}

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  const ivec3 hsv = ivec3(hue[index(p.hue, at)], saturation[index(p.saturation, at)], value[index(p.value, at)]);
  uint mark = 0;
  for (int t = 0; t < kMarkTargets; ++t) {
    const MarkTarget target = targets[t];
    if (at.x < target.x || at.y < target.y || at.x >= target.x_end || at.y >= target.y_end) continue;
    if (fits(target, hsv)) mark |= 1u << t;
  }
  marks[index(p.marks, at)] = uint8_t(mark);
}
