#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_16bit_storage : require
#include "vulkan/value_lanes.h"

// Moves 4 bytes a value of the result, 2 of them from the cache.
layout(local_size_x = kValueLanes) in;
layout(std430, binding = 0) readonly buffer X { int16_t x[]; };
layout(std430, binding = 1) writeonly buffer Y { int16_t y[]; };
layout(push_constant) uniform Push { ValuesPush p; };

void main() {
  const int i = int(gl_GlobalInvocationID.x), picture = int(gl_WorkGroupID.y);
  if (i >= p.channels * p.y_width * p.y_height) return;
  const int c = i % p.channels, ox = i / p.channels % p.y_width, oy = i / p.channels / p.y_width;
  const int from = p.x.offset + picture * p.x.stride;
  const ivec2 size = ivec2(p.y_width, p.y_height) / 2, at = ivec2(ox, oy), near = at / 2;
  const ivec2 far = clamp(near + 2 * (at & 1) - 1, ivec2(0), size - 1);
  const int value = 9 * int(x[from + (near.y * size.x + near.x) * p.channels + c]) +
                    3 * int(x[from + (near.y * size.x + far.x) * p.channels + c]) +
                    3 * int(x[from + (far.y * size.x + near.x) * p.channels + c]) +
                    int(x[from + (far.y * size.x + far.x) * p.channels + c]) + 8 >> 4;
  y[p.y.offset + picture * p.y.stride + i] = int16_t(value);
}
