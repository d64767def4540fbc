#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/blur/blur_params.h"
#include "stages/types/block_measure_params.h"

// The blur from the bins; one workgroup, of which four invocations walk along the bins of a picture and a distance each.
layout(local_size_x = 4) in;
layout(std430, binding = 0) readonly buffer Bins { uint bins[]; };  // [picture][distance][bin]
layout(std430, binding = 1) writeonly buffer Blur { uint blur_q4; };

layout(push_constant) uniform Push { QuantilePush p; };

shared int levels[4];

int ratio_q4(int near, int far) {
  return near == 0 ? kBlurUnknown : min(16 * (2 * far + 1) / (2 * near + 1), kBlurUnknown);
}

void main() {
  const int me = int(gl_LocalInvocationIndex), first = me * kBlurBins;
  int all = 0, below = 0, bin = 0;
  for (int i = 0; i < kBlurBins; ++i) all += int(bins[first + i]);
  for (; all > 0 && bin < kBlurBins; ++bin) {
    below += int(bins[first + bin]);
    if (p.share * below >= all) break;
  }
  levels[me] = bin;
  barrier();
  if (me == 0) blur_q4 = uint(max(ratio_q4(levels[0], levels[1]), ratio_q4(levels[2], levels[3])));
}
