#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#include "matchers/sgm/keep_confidence_params.h"

// duo::keep_confidence(). Moves 4 bytes a pixel.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer D { uint16_t d_q4[]; };
layout(std430, binding = 1) buffer Confidence { uint8_t confidence[]; };
layout(push_constant) uniform Push { KeepConfidencePush p; };

const uint kNone = 0xFFFF;

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  const int i = p.confidence.offset + at.y * p.confidence.stride + at.x;
  const bool none = uint(d_q4[p.d_q4.offset + at.y * p.d_q4.stride + at.x]) == kNone;
  confidence[i] = uint8_t(none ? 0 : max(uint(confidence[i]), 1));
}
