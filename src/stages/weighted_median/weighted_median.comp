#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/weighted_median/weighted_median_params.h"

// Bisection of the range of the taps' values: about ten rounds of 49 taps, kept packed in registers. Moves 5 bytes a pixel
// and 4.4 words into the tile; about 600 operations for the weights and 150 a round.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer D { uint16_t d_q4[]; };
layout(std430, binding = 1) readonly buffer Guide { uint8_t guide[]; };
layout(std430, binding = 2) writeonly buffer Dst { uint16_t dst[]; };
layout(push_constant) uniform Push { WeightedMedianPush p; };

const uint kNone = 0xFFFF;
const int kRadius = 6, kStep = 2, kSide = 2 * kRadius / kStep + 1, kTaps = kSide * kSide;
const int kTileWidth = kGroupWidth + 2 * kRadius, kTileHeight = kGroupHeight + 2 * kRadius;
// WeightedMedian::kWeights, four to a word.
const uvec4 kWeights = uvec4(57 | 43 << 8 | 32 << 16 | 24 << 24, 18 | 14 << 8 | 10 << 16 | 8 << 24,
                             6 | 4 << 8 | 3 << 16 | 2 << 24, 2 | 1 << 8 | 1 << 16 | 1 << 24);
shared uint tile[kTileHeight * kTileWidth];  // value | guide << 16

int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }

uint load(ivec2 at) {
  if (at.x < 0 || at.x >= p.width || at.y < 0 || at.y >= p.height) return kNone;
  return uint(d_q4[index(p.d_q4, at)]) | uint(guide[index(p.guide, at)]) << 16;
}

uint weight_of(uint difference) { return kWeights[difference >> 4] >> ((difference >> 2 & 3) * 8) & 0xFF; }

uint median_around(int centre) {
  const int centre_guide = int(tile[centre] >> 16);
  uint taps[kTaps];  // weight << 16 | value; in registers, as both loops over it are unrolled
  uint total = 0, low = kNone, high = 0;
  int corner = centre - kRadius * kTileWidth - kRadius;
  [[unroll]] for (int i = 0; i < kTaps; ++i) {
    const uint tap = tile[corner + i / kSide * kStep * kTileWidth + i % kSide * kStep], value = tap & kNone;
    const uint difference = uint(abs(int(tap >> 16) - centre_guide));
    const uint weight = value != kNone && difference < 64 ? weight_of(difference) : 0;
    taps[i] = weight << 16 | value;
    total += weight;
    if (weight != 0) {
      low = min(low, value);
      high = max(high, value);
    }
  }
  // The smallest value up to which there is half of all weight.
  while (low < high) {
    const uint middle = (low + high) >> 1;
    uint sum = 0;
    [[unroll]] for (int i = 0; i < kTaps; ++i) sum += (taps[i] & kNone) <= middle ? taps[i] >> 16 : 0;
    if (2 * sum >= total)
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

void main() {
  const ivec2 corner = ivec2(gl_WorkGroupID.xy) * ivec2(kGroupWidth, kGroupHeight) - kRadius;
  for (int i = int(gl_LocalInvocationIndex); i < kTileWidth * kTileHeight; i += kGroupWidth * kGroupHeight)
    tile[i] = load(corner + ivec2(i % kTileWidth, i / kTileWidth));
  barrier();

  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  const int centre = (int(gl_LocalInvocationID.y) + kRadius) * kTileWidth + int(gl_LocalInvocationID.x) + kRadius;
  uint value = tile[centre] & kNone;
  if (value != kNone) value = median_around(centre);
  dst[index(p.dst, at)] = uint16_t(value);
}
