#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#include "stages/blur/blur_params.h"
#include "stages/types/block_measure_params.h"

// An invocation a block: its 14x14 pixels. Moves half of both pictures' bytes, nearly all reads from the cache; 24 operations a
// pixel looked at.
layout(local_size_x = kMeasureGroup) in;
layout(std430, binding = 0) readonly buffer Left { uint8_t left[]; };
layout(std430, binding = 1) readonly buffer Right { uint8_t right[]; };
layout(std430, binding = 2) buffer Bins { uint bins[]; };  // [picture][distance][bin], 0 at first
layout(push_constant) uniform Push { CountBlocksPush p; };

int pixel(bool of_right, int y, int x) {
  return of_right ? int(right[p.right.offset + y * p.right.stride + x]) : int(left[p.left.offset + y * p.left.stride + x]);
}

int along(bool of_right, int y, int x, int distance) {
  return pixel(of_right, y, x - distance) - 2 * pixel(of_right, y, x) + pixel(of_right, y, x + distance);
}

int difference(bool of_right, int y, int x, int distance) {
  return abs(along(of_right, y - distance, x, distance) - 2 * along(of_right, y, x, distance) +
             along(of_right, y + distance, x, distance));
}

void count(int distance, int first_bin, int sum) { atomicAdd(bins[first_bin + distance * kBlurBins + min(sum / kBlurBinStep, kBlurBins - 1)], 1); }

void main() {
  const bool of_right = gl_WorkGroupID.y != 0;
  const int block = int(gl_GlobalInvocationID.x);
  if (block >= p.blocks_x * p.blocks_y) return;
  const int x0 = kBlurFar + kBlurBlock * (block % p.blocks_x), y0 = kBlurFar + kBlurRowStep * (block / p.blocks_x);
  int near = 0, far = 0;
  bool counts = true;
  for (int y = y0; y < y0 + kBlurBlock; ++y)
    for (int x = x0; x < x0 + kBlurBlock; ++x) {
      const int v = pixel(of_right, y, x);
      counts = counts && v != 0 && v != 255;
      near += difference(of_right, y, x, 1);
      far += difference(of_right, y, x, kBlurFar);
    }
  if (!counts) return;
  const int first = of_right ? 2 * kBlurBins : 0;
  count(0, first, near);
  count(1, first, far);
}
