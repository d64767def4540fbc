#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#include "matchers/sgm/keep_confidence_params.h"

// Margins become confidences, in place. Moves 4 bytes a pixel, 2 operations.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer Disparity { uint16_t d_q4[]; };
layout(std430, binding = 1) buffer Confidence { uint8_t confidence[]; };
layout(push_constant) uniform Push { KeepConfidencePush p; };

const uint kNone = 0xFFFF;

int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  const int i = index(p.confidence, at);
  confidence[i] = uint8_t(uint(d_q4[index(p.d_q4, at)]) == kNone ? 0 : max(uint(confidence[i]), 1));
}
