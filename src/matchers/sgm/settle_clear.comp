#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/types/clear.h"
#include "stages/types/noise.h"
#include "matchers/sgm/settle_clear_params.h"

// Noise of coding, duo::looks_clear() and ClearStream::next(): recordings run one after the other, in the order of their pairs.
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Noise { uint noise_q4; };  // 0 once it was looked at, where it must not count further on
layout(std430, binding = 1) readonly buffer Blur { uint blur_q4; };
layout(std430, binding = 2) readonly buffer Coding { int coding_noise_q4; };
layout(std430, binding = 3) buffer Stream { int known; };
layout(push_constant) uniform Push { SettleClearPush p; };

void main() {
  noise_q4 = max(noise_q4, uint(noise_of_coding_q4(coding_noise_q4)));
  const bool measured = noise_q4 == 0 && blur_q4 < kClearBlur_q4;
  known = next_clear(known, p.clear != 1 ? p.clear == 2 : measured);
  if (p.soften == 0) noise_q4 = 0;
}
