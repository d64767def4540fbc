#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/matmul16/matmul16_params.h"

// A tile of 32 x 32 sums: for each 16 pairs of inputs, 4 kB go through shared memory and each value is used 32 times. The pixels
// of all pictures are one row, so that small layers fill tiles, too.
const int kLanes = 8, kEach = 4;
layout(local_size_x = kLanes, local_size_y = kLanes) in;
layout(std430, binding = 0) readonly buffer X { int16_t x[]; };
layout(std430, binding = 1) readonly buffer Packed { int packed[]; };
layout(std430, binding = 2) writeonly buffer Y { int16_t y[]; };
layout(push_constant) uniform Push { Matmul16Push p; };

const int kBlock = 16, kChunkPairs = 64;
shared int inputs[kTilePairs * kTilePixels];
shared int weights[kTilePairs * kTileOutputs];

int low_half(int word) { return (word << 16) >> 16; }
int high_half(int word) { return word >> 16; }

int block_of(int n) { return p.at + n / kBlock * kBlock * (2 + p.inputs / 2) + n % kBlock; }

void main() {
  const int me = int(gl_LocalInvocationIndex), pairs = p.inputs / 2, all = p.pixels * p.pictures;
  const int first_pixel = int(gl_WorkGroupID.x) * kTilePixels, first_output = int(gl_WorkGroupID.y) * kTileOutputs;
  const int lane_output = int(gl_LocalInvocationID.x), lane_pixel = int(gl_LocalInvocationID.y);
  const int half_step = (1 << p.fold) / 2;
  int sum[kEach][kEach], total[kEach][kEach];
  for (int i = 0; i < kEach; ++i)
    for (int j = 0; j < kEach; ++j) sum[i][j] = total[i][j] = 0;
  for (int begin = 0; begin < pairs; begin += kTilePairs) {
    for (int i = me; i < kTilePairs * kTilePixels; i += kLanes * kLanes) {
      const int pair = begin + i % kTilePairs, pixel = first_pixel + i / kTilePairs;
      int word = 0;
      if (pair < pairs && pixel < all) {
        const int from = p.x.offset + pixel / p.pixels * p.x.stride + pixel % p.pixels * p.inputs + 2 * pair;
        word = (int(x[from]) & 0xFFFF) | int(x[from + 1]) << 16;
      }
      inputs[i % kTilePairs * kTilePixels + i / kTilePairs] = word;
    }
    for (int i = me; i < kTilePairs * kTileOutputs; i += kLanes * kLanes) {
      const int pair = begin + i / kTileOutputs, n = first_output + i % kTileOutputs;
      int word = 0;
      if (pair < pairs && n < p.outputs) word = packed[block_of(n) + (2 + pair) * kBlock];
      weights[i] = word;
    }
    barrier();
    for (int pair = 0; pair < kTilePairs; ++pair) {
      int a[kEach], b[kEach];
      for (int i = 0; i < kEach; ++i) a[i] = inputs[pair * kTilePixels + lane_pixel + kLanes * i];
      for (int j = 0; j < kEach; ++j) b[j] = weights[pair * kTileOutputs + lane_output + kLanes * j];
      for (int i = 0; i < kEach; ++i)
        for (int j = 0; j < kEach; ++j)
          sum[i][j] += low_half(a[i]) * low_half(b[j]) + high_half(a[i]) * high_half(b[j]);
    }
    barrier();
    const int end = begin + kTilePairs;
    if (end % kChunkPairs == 0 || end >= pairs)
      for (int i = 0; i < kEach; ++i)
        for (int j = 0; j < kEach; ++j) {
          total[i][j] += (sum[i][j] + half_step) >> p.fold;
          sum[i][j] = 0;
        }
  }
  for (int j = 0; j < kEach; ++j) {
    const int n = first_output + lane_output + kLanes * j;
    if (n >= p.outputs) continue;
    const int block = block_of(n), bias = packed[block], shift = packed[block + kBlock];
    for (int i = 0; i < kEach; ++i) {
      const int pixel = first_pixel + lane_pixel + kLanes * i;
      if (pixel >= all) continue;
      const int value = clamp((total[i][j] + bias) >> shift, p.low, p.high);
      y[p.y.offset + pixel / p.pixels * p.y.stride + pixel % p.pixels * p.outputs + n] = int16_t(value);
    }
  }
}
