#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/semi_global/semi_global_params.h"

// Sub-pixel disparities from what the winners' kernel found. Moves 9 bytes a pixel, 20 operations and one division.
layout(local_size_x = kGroupWidth, local_size_y = kGroupHeight) in;
layout(std430, binding = 0) readonly buffer Found { uint found[]; };
layout(std430, binding = 1) writeonly buffer LeftWinner { int16_t left_winner[]; };
layout(std430, binding = 2) writeonly buffer Fine { uint16_t fine[]; };
layout(std430, binding = 3) writeonly buffer Margin { uint8_t margin[]; };
layout(push_constant) uniform Push { SemiGlobalFinePush p; };

int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }

int sub_pixel_q4(int before, int after) {
  const int higher = max(before, after), slope = before - after, height = higher * (before + after);
  if (higher == 0) return 0;
  const int t = (128 * abs(slope) * (higher + before + after) + height / 2) / height;
  const int size = (t * (768 - t) + 8192) >> 14;
  return slope < 0 ? -size : size;
}

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= p.width || at.y >= p.height) return;
  const uvec4 what = uvec4(found[at.y * p.width + at.x]) >> uvec4(0, 8, 16, 24) & 0xFF;
  const int d = int(what.x);
  const bool at_end = d == 0 || d + 1 == p.max_disparity;
  left_winner[index(p.left_winner, at)] = int16_t(d);
  fine[index(p.fine, at)] = uint16_t(16 * d + (at_end ? 0 : sub_pixel_q4(int(what.y), int(what.z))));
  if (p.wants_margin != 0) margin[index(p.margin, at)] = uint8_t(what.w);
}
