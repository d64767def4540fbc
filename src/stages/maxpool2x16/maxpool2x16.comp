#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_16bit_storage : require
#include "vulkan/value_lanes.h"

// Moves 10 bytes a value of the result.
layout(local_size_x = kValueLanes) in;
layout(std430, binding = 0) readonly buffer X { int16_t x[]; };
layout(std430, binding = 1) writeonly buffer Y { int16_t y[]; };
layout(push_constant) uniform Push { ValuesPush p; };

void main() {
  const int i = int(gl_GlobalInvocationID.x), picture = int(gl_WorkGroupID.y);
  if (i >= p.channels * p.y_width * p.y_height) return;
  const int c = i % p.channels, ox = i / p.channels % p.y_width, oy = i / p.channels / p.y_width;
  const int from = p.x.offset + picture * p.x.stride;
  const int upper = from + (2 * oy * 2 * p.y_width + 2 * ox) * p.channels + c, lower = upper + 2 * p.y_width * p.channels;
  const int value = max(max(int(x[upper]), int(x[upper + p.channels])), max(int(x[lower]), int(x[lower + p.channels])));
  y[p.y.offset + picture * p.y.stride + i] = int16_t(value);
}
