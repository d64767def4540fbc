#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#include "stages/types/noise.h"
#include "stages/types/block_measure_params.h"

// An invocation a block: its 10x10 pixels, row by row. Moves half of both pictures' bytes; 6 operations a pixel looked at.
layout(local_size_x = kMeasureGroup) in;
layout(std430, binding = 0) readonly buffer Left { uint8_t left[]; };
layout(std430, binding = 1) readonly buffer Right { uint8_t right[]; };
layout(std430, binding = 2) buffer Bins { uint bins[]; };  // [picture][bin], 0 at first
layout(push_constant) uniform Push { CountBlocksPush p; };

int pixel(bool of_right, int y, int x) {
  return of_right ? int(right[p.right.offset + y * p.right.stride + x]) : int(left[p.left.offset + y * p.left.stride + x]);
}

void main() {
  const bool of_right = gl_WorkGroupID.y != 0;
  const int block = int(gl_GlobalInvocationID.x);
  if (block >= p.blocks_x * p.blocks_y) return;
  const int x0 = kNoiseBlock * (block % p.blocks_x), y0 = kNoiseRowStep * (block / p.blocks_x);

  int sum = 0;
  bool counts = true;
  // Second differences along the two rows before.
  int above[kNoiseBlock], here[kNoiseBlock];
  for (int y = 0; y < kNoiseBlock + 2; ++y) {
    int before = pixel(of_right, y0 + y, x0), v = pixel(of_right, y0 + y, x0 + 1);
    for (int i = 0; i < kNoiseBlock; ++i) {
      const int next = pixel(of_right, y0 + y, x0 + i + 2), along = before - 2 * v + next;
      if (y >= 1 && y <= kNoiseBlock) counts = counts && v != 0 && v != 255;
      if (y >= 2) sum += abs(above[i] - 2 * here[i] + along);
      above[i] = here[i];
      here[i] = along;
      before = v;
      v = next;
    }
  }
  if (counts) atomicAdd(bins[(of_right ? kNoiseBins : 0) + min(sum / kNoiseBinStep, kNoiseBins - 1)], 1);
}
