#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/rectify/rectify_params.h"

layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer Src { uint8_t src[]; };
layout(std430, binding = 1) readonly buffer Corner { uint corner[]; };
layout(std430, binding = 2) readonly buffer Fraction { uint16_t fraction_q8[]; };
layout(std430, binding = 3) writeonly buffer Dst { uint8_t dst[]; };
layout(std430, binding = 4) writeonly buffer Inside { uint8_t inside[]; };
layout(push_constant) uniform Push { RectifyPush p; };

const uint kOutside = 0xFFFFFFFF;

int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  const uint from = corner[index(p.corner, at)];
  uint value = 0;
  if (from != kOutside) {
    const int i = index(p.src, ivec2(from >> 16, from & 0xFFFF));
    const uint fraction = uint(fraction_q8[index(p.fraction, at)]);
    const uint fx = fraction >> 8, fy = fraction & 0xFF;
    const uint top = uint(src[i]) * (256 - fx) + uint(src[i + 1]) * fx;
    const uint bottom = uint(src[i + p.src.stride]) * (256 - fx) + uint(src[i + p.src.stride + 1]) * fx;
    value = (top * (256 - fy) + bottom * fy + 32768) >> 16;
  }
  dst[index(p.dst, at)] = uint8_t(value);
  inside[index(p.inside, at)] = uint8_t(from != kOutside ? 255 : 0);
}
