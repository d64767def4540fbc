#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "stages/sums/sums_params.h"

// Moves up to 4 bytes a pixel of each area (mark, hue, disparity; the last two only where marked) and 3 KiB of partial sums an
// area, twice; about 15 operations a pixel and 40 more where marked, a third of them on pairs of words. Three barriers a workgroup.
layout(local_size_x = kAreaLanes) in;

const int kSums = 10;
// duo::AreaSums: count x y xx xy yy known d_q4 hue_cos hue_sin, then the corners y x, y x.
struct AreaSums {
  int64_t sums[kSums];
  int first_y, first_x, last_y, last_x;
};

layout(std430, binding = 0) readonly buffer Areas { DeviceArea areas[]; };
layout(std430, binding = 1) readonly buffer Marks { uint8_t marks[]; };
layout(std430, binding = 2) readonly buffer Hue { uint8_t hue[]; };
layout(std430, binding = 3) readonly buffer Disparity { uint16_t d_q4[]; };
layout(std430, binding = 4) buffer Partial { AreaSums partial[]; };  // kAreaGroups an area
layout(std430, binding = 5) writeonly buffer Results { AreaSums results[]; };
layout(push_constant) uniform Push { SumsPush p; };

const int kQuarterSine_q14[65] = int[65](
#include "stages/sums/quarter_sine.inc"
);
const int kNone = 0xFFFF, kFar = 0x7FFFFFFF;
const int kParts = 8;  // of the lanes: each is added up by one invocation a sum

shared int sine_q14[65];
shared int64_t lane_sums[kSums][kAreaLanes];
shared int64_t part_sums[kSums][kParts];
shared int first_y, first_x, last_y, last_x;

int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }

int hue_sin_q14(int angle) {
  const int in_half = angle & 127, sine = sine_q14[in_half <= 64 ? in_half : 128 - in_half];
  return (angle & 128) != 0 ? -sine : sine;
}

void take_corners(ivec4 corners) {
  atomicMin(first_y, corners.x);
  atomicMin(first_x, corners.y);
  atomicMax(last_y, corners.z);
  atomicMax(last_x, corners.w);
}

// Adds up this invocation's share of the area's pixels.
void add_pixels(DeviceArea area, inout int64_t sums[kSums]) {
  const ivec4 bounds = bounds_of(area, ivec2(p.width, p.height));
  const int wide = bounds.z - bounds.x, pixels = wide * (bounds.w - bounds.y);
  ivec4 corners = ivec4(kFar, kFar, -1, -1);
  for (int i = int(gl_GlobalInvocationID.x); i < pixels; i += kAreaGroups * kAreaLanes) {
    const ivec2 at = bounds.xy + ivec2(i % wide, i / wide);
    if (!in_disc(area, at)) continue;
    if (p.with_marks != 0 && (int(marks[index(p.marks, at)]) & area.bits) == 0) continue;
    corners = ivec4(min(corners.xy, at.yx), max(corners.zw, at.yx));
    sums[0] += 1;
    sums[1] += at.x;
    sums[2] += at.y;
    sums[3] += at.x * at.x;
    sums[4] += at.x * at.y;
    sums[5] += at.y * at.y;
    const int d = p.with_d != 0 ? int(d_q4[index(p.d, at)]) : kNone;
    if (d != kNone) {
      sums[6] += 1;
      sums[7] += d;
    }
    if (p.with_hue != 0) {
      const int angle = int(hue[index(p.hue, at)]);
      sums[8] += hue_sin_q14(angle + 64);
      sums[9] += hue_sin_q14(angle);
    }
  }
  if (corners.z >= 0) take_corners(corners);
}

void main() {
  const int lane = int(gl_LocalInvocationIndex), group = int(gl_WorkGroupID.x), area = int(gl_WorkGroupID.y);
  if (lane < 65) sine_q14[lane] = kQuarterSine_q14[lane];
  if (lane == 0) {
    first_y = first_x = kFar;
    last_y = last_x = -1;
  }
  barrier();

  int64_t sums[kSums] = int64_t[](0, 0, 0, 0, 0, 0, 0, 0, 0, 0);
  if (p.partial != 0) {
    add_pixels(areas[area], sums);
  } else if (lane < kAreaGroups) {
    const AreaSums one = partial[area * kAreaGroups + lane];
    sums = one.sums;
    if (one.sums[0] > 0) take_corners(ivec4(one.first_y, one.first_x, one.last_y, one.last_x));
  }
  for (int i = 0; i < kSums; ++i) lane_sums[i][lane] = sums[i];
  barrier();
  if (lane < kSums * kParts) {
    const int sum = lane / kParts, part = lane % kParts;
    int64_t total = 0;
    for (int i = part; i < kAreaLanes; i += kParts) total += lane_sums[sum][i];
    part_sums[sum][part] = total;
  }
  barrier();
  if (lane != 0) return;
  AreaSums all;
  for (int i = 0; i < kSums; ++i) {
    all.sums[i] = 0;
    for (int part = 0; part < kParts; ++part) all.sums[i] += part_sums[i][part];
  }
  const bool found = all.sums[0] > 0;
  all.first_y = found ? first_y : -1;
  all.first_x = found ? first_x : -1;
  all.last_y = last_y;
  all.last_x = last_x;
  if (p.partial != 0)
    partial[area * kAreaGroups + group] = all;
  else
    results[area] = all;
}
