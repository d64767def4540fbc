#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/add16/add16_params.h"

// Moves 6 bytes a value.
layout(local_size_x = kValueLanes) in;
layout(std430, binding = 0) readonly buffer A { int16_t a[]; };
layout(std430, binding = 1) readonly buffer B { int16_t b[]; };
layout(std430, binding = 2) writeonly buffer Y { int16_t y[]; };
layout(push_constant) uniform Push { Add16Push p; };

void main() {
  const int i = int(gl_GlobalInvocationID.x), picture = int(gl_WorkGroupID.y);
  if (i >= p.count) return;
  const int c = i % p.channels;
  int sum = (int(a[p.a.offset + picture * p.a.stride + i]) << p.left_a) + (1 << p.shift) / 2;
  if (c < p.of_b) sum += int(b[p.b.offset + picture * p.b.stride + i / p.channels * p.of_b + c]) << p.left_b;
  y[p.y.offset + picture * p.y.stride + i] = int16_t(clamp(sum >> p.shift, p.low, p.high));
}
