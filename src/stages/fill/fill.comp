#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/fill/fill_params.h"

// Moves 3 bytes a pixel to mark, 5 where it fills. One workgroup a row: what was measured becomes one bit a pixel in shared
// memory, and a hole looks along whole words of it: the nearest measurement is a read or two away, and width / 32 at most.
layout(local_size_x = kFillGroup) in;
layout(std430, binding = 0) buffer Disparity { uint16_t d_q4[]; };
layout(std430, binding = 1) writeonly buffer Origin { uint8_t origin[]; };
layout(push_constant) uniform Push { FillPush p; };

const uint kNone = 0xFFFF, kOriginNone = 0, kOriginMeasured = 1, kOriginFilled = 2;
shared uint measured[kFillMaxWidth / 32];

// The disparity of the last measured pixel at or before x, kNone if there is none.
uint before(int row, int x) {
  int word = x / 32;
  uint bits = measured[word] & (0xFFFFFFFFu >> (31 - x % 32));
  while (bits == 0 && word > 0) bits = measured[--word];
  return bits == 0 ? kNone : uint(d_q4[row + 32 * word + findMSB(bits)]);
}

// The same at or after x.
uint after(int row, int x) {
  const int last = (p.width - 1) / 32;
  int word = x / 32;
  uint bits = measured[word] & (0xFFFFFFFFu << (x % 32));
  while (bits == 0 && word < last) bits = measured[++word];
  return bits == 0 ? kNone : uint(d_q4[row + 32 * word + findLSB(bits)]);
}

void main() {
  const int me = int(gl_LocalInvocationIndex), y = int(gl_WorkGroupID.x);
  const int row = p.d_q4.offset + y * p.d_q4.stride, origin_row = p.origin.offset + y * p.origin.stride;
  for (int i = me; 32 * i < p.width; i += kFillGroup) measured[i] = 0;
  barrier();
  for (int x = me; x < p.width; x += kFillGroup)
    if (uint(d_q4[row + x]) != kNone) atomicOr(measured[x / 32], 1u << (x % 32));
  barrier();
  for (int x = me; x < p.width; x += kFillGroup) {
    uint from = kOriginMeasured;
    if ((measured[x / 32] >> (x % 32) & 1) == 0) {
      // Only holes are written, only what was measured is read: the order of invocations does not matter.
      const uint value = p.fills != 0 ? min(before(row, x), after(row, x)) : kNone;
      if (value != kNone) d_q4[row + x] = uint16_t(value);
      from = value != kNone ? kOriginFilled : kOriginNone;
    }
    origin[origin_row + x] = uint8_t(from);
  }
}
