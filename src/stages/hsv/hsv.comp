#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#include "stages/hsv/hsv_params.h"

// Moves 6 W H bytes, in single bytes that neighbouring invocations merge; about 60 operations a pixel, most of them in the two
// integer divisions, since float division need not be correctly rounded here.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer Src { uint8_t src[]; };
layout(std430, binding = 1) writeonly buffer Hue { uint8_t hue[]; };
layout(std430, binding = 2) writeonly buffer Saturation { uint8_t saturation[]; };
layout(std430, binding = 3) writeonly buffer Value { uint8_t value[]; };
layout(push_constant) uniform Push { HsvPush p; };

int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }

// The hue's share of the circle in sixths, times the chroma.
int sixths_of(ivec3 color, int largest, int chroma) {
  if (color.r == largest) return color.g - color.b + (color.g >= color.b ? 0 : 6 * chroma);
  if (color.g == largest) return color.b - color.r + 2 * chroma;
  return color.r - color.g + 4 * chroma;
}

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  const int from = 3 * index(p.src, at);
  const ivec3 color = ivec3(src[from], src[from + 1], src[from + 2]);
  const int largest = max(max(color.r, color.g), color.b), chroma = largest - min(min(color.r, color.g), color.b);

  // Divisors of at least 1: a zero comes only with a dividend below it.
  const uint turn = uint(256 * sixths_of(color, largest, chroma) + 3 * chroma) / uint(max(6 * chroma, 1));
  const uint share = uint(510 * chroma + largest) / uint(max(2 * largest, 1));
  hue[index(p.hue, at)] = uint8_t(turn & 255);
  saturation[index(p.saturation, at)] = uint8_t(share);
  value[index(p.value, at)] = uint8_t(largest);
}
