#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/depthwise16/depthwise16_params.h"

// Neighbouring lanes are channels of a pixel: each moves 2 bytes a place of the window, most of them from the cache, and 2 of
// weights.
layout(local_size_x = kValueLanes) in;
layout(std430, binding = 0) readonly buffer X { int16_t x[]; };
layout(std430, binding = 1) readonly buffer Packed { int packed[]; };
layout(std430, binding = 2) writeonly buffer Y { int16_t y[]; };
layout(push_constant) uniform Push { Depthwise16Push p; };

void main() {
  const int i = int(gl_GlobalInvocationID.x), picture = int(gl_WorkGroupID.y);
  if (i >= p.count) return;
  const int c = i % p.channels, ox = i / p.channels % p.y_width, oy = i / p.channels / p.y_width;
  const int x_first = ox * p.stride - p.pad_left, y_first = oy * p.stride - p.pad_top;
  const int from = p.x.offset + picture * p.x.stride + c, weights = p.at + 2 * p.channels + c;
  int sum = packed[p.at + c];
  for (int r = max(0, -y_first); r < min(p.window, p.x_height - y_first); ++r)
    for (int s = max(0, -x_first); s < min(p.window, p.x_width - x_first); ++s) {
      const int place = r * p.window + s, pair = packed[weights + place / 2 * p.channels];
      const int weight = (place % 2 == 0 ? pair << 16 : pair) >> 16;
      sum += int(x[from + ((y_first + r) * p.x_width + x_first + s) * p.channels]) * weight;
    }
  const int value = clamp(sum >> packed[p.at + p.channels + c], p.low, p.high);
  y[p.y.offset + picture * p.y.stride + i] = int16_t(value);
}
