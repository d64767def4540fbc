#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/sum_pixels16/sum_pixels16_params.h"

// Moves 2 bytes a value of the picture; neighbouring lanes are channels. Pictures have few pixels here.
layout(local_size_x = kValueLanes) in;
layout(std430, binding = 0) readonly buffer X { int16_t x[]; };
layout(std430, binding = 1) writeonly buffer Y { int16_t y[]; };
layout(push_constant) uniform Push { SumPixels16Push p; };

void main() {
  const int c = int(gl_GlobalInvocationID.x), picture = int(gl_WorkGroupID.y);
  if (c >= p.channels) return;
  const int from = p.x.offset + picture * p.x.stride + c;
  int sum = (1 << p.shift) / 2;
  for (int i = 0; i < p.pixels; ++i) sum += int(x[from + i * p.channels]);
  y[p.y.offset + picture * p.y.stride + c] = int16_t(sum >> p.shift);
}
