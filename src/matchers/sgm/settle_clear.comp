#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/types/clear.h"
#include "matchers/sgm/settle_clear_params.h"

// duo::looks_clear() and ClearStream::next(): recordings run one after the other, in the order of their pairs.
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Noise { uint noise_q4; };  // what counts further on, once it was looked at
layout(std430, binding = 1) readonly buffer Blur { uint blur_q4; };
layout(std430, binding = 2) buffer Stream { int known; };
layout(std430, binding = 3) writeonly buffer P2Least { int p2_least; };
layout(push_constant) uniform Push { SettleClearPush p; };

void main() {
  const bool measured = noise_q4 == 0 && blur_q4 < kClearBlur_q4;
  known = next_clear(known, p.clear != 1 ? p.clear == 2 : measured);
  p2_least = least_p2(known > 0, int(noise_q4), p.p2, p.p2_least);
  noise_q4 = p.soften != 0 ? counted_noise_q4(known > 0, int(noise_q4)) : 0;
}
