#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/conv_first16/conv_first16_params.h"

// Neighbouring lanes are outputs of a pixel, which read the same 27 values: 54 bytes a pixel and 1 a product of weights, from the
// cache.
layout(local_size_x = kValueLanes) in;
layout(std430, binding = 0) readonly buffer X { int16_t x[]; };
layout(std430, binding = 1) readonly buffer Packed { int packed[]; };
layout(std430, binding = 2) writeonly buffer Y { int16_t y[]; };
layout(push_constant) uniform Push { ConvFirst16Push p; };

const int kBlock = 16, kBlockWords = kBlock * (2 + 15);

void main() {
  const int i = int(gl_GlobalInvocationID.x), picture = int(gl_WorkGroupID.y);
  if (i >= p.count) return;
  const int n = i % p.outputs, ox = i / p.outputs % (p.x_width / 2), oy = i / p.outputs / (p.x_width / 2);
  const int x_first = 2 * ox - p.pad_left, y_first = 2 * oy - p.pad_top;
  const int block = p.at + n / kBlock * kBlockWords + n % kBlock, from = p.x.offset + picture * p.x.stride;
  int sum = packed[block];
  for (int r = max(0, -y_first); r < min(3, p.x_height - y_first); ++r)
    for (int s = max(0, -x_first); s < min(3, p.x_width - x_first); ++s)
      for (int c = 0; c < 3; ++c) {
        const int place = 3 * s + c, pair = packed[block + (2 + 5 * r + place / 2) * kBlock];
        const int weight = (place % 2 == 0 ? pair << 16 : pair) >> 16;
        sum += int(x[from + ((y_first + r) * p.x_width + x_first + s) * 3 + c]) * weight;
      }
  const int value = clamp(sum >> packed[block + kBlock], p.low, p.high);
  y[p.y.offset + picture * p.y.stride + i] = int16_t(value);
}
