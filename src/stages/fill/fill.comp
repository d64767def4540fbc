#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/fill/fill_params.h"

// mark_measured(). Moves 3 bytes a pixel.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer Disparity { uint16_t d_q4[]; };
layout(std430, binding = 1) writeonly buffer Origin { uint8_t origin[]; };
layout(push_constant) uniform Push { FillPush p; };

const uint kNone = 0xFFFF, kOriginNone = 0, kOriginMeasured = 1;

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  const bool none = uint(d_q4[p.d_q4.offset + at.y * p.d_q4.stride + at.x]) == kNone;
  origin[p.origin.offset + at.y * p.origin.stride + at.x] = uint8_t(none ? kOriginNone : kOriginMeasured);
}
