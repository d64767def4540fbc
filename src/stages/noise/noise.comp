#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/types/noise.h"
#include "stages/types/block_measure_params.h"

// The level from the bins; one workgroup, of which two invocations walk along a picture's bins each.
layout(local_size_x = 2) in;
layout(std430, binding = 0) readonly buffer Bins { uint bins[]; };  // [picture][bin]
layout(std430, binding = 1) writeonly buffer Noise { uint noise_q4; };
layout(push_constant) uniform Push { QuantilePush p; };

shared int levels[2];

void main() {
  const int picture = int(gl_LocalInvocationIndex), first = picture * kNoiseBins;
  int all = 0, below = 0, bin = 0;
  for (int i = 0; i < kNoiseBins; ++i) all += int(bins[first + i]);
  for (; bin < kNoiseBins; ++bin) {
    below += int(bins[first + bin]);
    if (p.share * below >= all) break;
  }
  levels[picture] = all == 0 ? 0 : noise_of_bin_q4(bin);
  barrier();
  if (picture == 0) noise_q4 = uint(max(levels[0], levels[1]));
}
