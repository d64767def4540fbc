#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/mark_targets/mark_targets_params.h"

// Moves 4 W H bytes, 2 W H more with disparity and 2 W H more with a background; about 10 operations a pixel and 25 more for each
// window that it lies in. The targets are the same for all invocations and stay in the cache, as do the 1 KiB of a table.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer Wanted {
  MarkTarget targets[kMarkTargets];
  uint8_t likelihoods[];  // kMarkBins each
};
layout(std430, binding = 1) readonly buffer Hue { uint8_t hue[]; };
layout(std430, binding = 2) readonly buffer Saturation { uint8_t saturation[]; };
layout(std430, binding = 3) readonly buffer Value { uint8_t value[]; };
layout(std430, binding = 4) readonly buffer Disparity { uint16_t d_q4[]; };
layout(std430, binding = 5) readonly buffer Background { uint16_t background_q4[]; };
layout(std430, binding = 6) writeonly buffer Marks { uint8_t marks[]; };
layout(push_constant) uniform Push { MarkTargetsPush p; };

const int kNone = 0xFFFF;

int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }

bool color_fits(MarkTarget target, ivec3 hsv) {
  if (hsv.y < target.min_saturation || hsv.z < target.min_value) return false;
  if (target.likelihood >= 0)
    return int(likelihoods[target.likelihood * kMarkBins + (hsv.x >> 3) * 32 + (hsv.y >> 3)]) >= target.min_likelihood;
  const int around = (hsv.x - target.hue) & 255;
  return min(around, 256 - around) <= target.hue_tolerance;
}

bool depth_passes(MarkTarget target, int d, int background) {
  if (d == kNone) return target.pass_unknown != 0;
  if (d < target.min_q4 || d > target.max_q4) return false;
  return background == kNone || abs(d - background) > target.background_tolerance_q4;
}

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  const ivec3 hsv = ivec3(hue[index(p.hue, at)], saturation[index(p.saturation, at)], value[index(p.value, at)]);
  const int d = p.with_d != 0 ? int(d_q4[index(p.d, at)]) : kNone;
  const int background = p.with_background != 0 ? int(background_q4[index(p.background, at)]) : kNone;
  uint mark = 0;
  for (int t = 0; t < kMarkTargets; ++t) {
    const MarkTarget target = targets[t];
    if (at.x < target.x || at.y < target.y || at.x >= target.x_end || at.y >= target.y_end) continue;
    if (color_fits(target, hsv) && depth_passes(target, d, background)) mark |= 1u << t;
  }
  marks[index(p.marks, at)] = uint8_t(mark);
}
