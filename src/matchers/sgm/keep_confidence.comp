#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#include "matchers/sgm/keep_confidence_params.h"

// duo::keep_confidence(). Moves 4 bytes a pixel, and reads 49 disparities, most of which lie in the caches.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer D { uint16_t d_q4[]; };
layout(std430, binding = 1) buffer Confidence { uint8_t confidence[]; };
layout(push_constant) uniform Push { KeepConfidencePush p; };

const int kNone = 0xFFFF;

int disparity_q4(ivec2 at) { return int(d_q4[p.d_q4.offset + at.y * p.d_q4.stride + at.x]); }

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  const int i = p.confidence.offset + at.y * p.confidence.stride + at.x, d = disparity_q4(at);
  const ivec2 first = max(at - kConfidenceReach, ivec2(0)), last = min(at + kConfidenceReach, ivec2(p.width, p.height) - 1);
  int least = d, most = d;
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x) {
      const int beside = disparity_q4(ivec2(x, y));
      if (beside != kNone) {
        least = min(least, beside);
        most = max(most, beside);
      }
    }
  confidence[i] = uint8_t(d == kNone ? 0 : confidence_of(int(confidence[i]), most - least));
}
