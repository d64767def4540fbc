#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "stages/semi_global/semi_global_params.h"

// All paths of one direction, a subgroup each. A diagonal that leaves the picture at one side starts anew at the other, so that all
// lines are equally long. For W x H x D cells: reads W H D bytes of costs and writes as many, and with `adds` reads as many once
// more; 12 operations a cell.
layout(local_size_x = kPathGroup) in;
layout(std430, binding = 0) readonly buffer Costs { uint costs[]; };
layout(std430, binding = 1) readonly buffer Left { uint left_planes[]; };
layout(std430, binding = 2) buffer Volume { uint volume[]; };  // sums of paths, laid out as the costs
layout(push_constant) uniform Push { SemiGlobalPathPush p; };
#include "stages/semi_global/semi_global_path.glsl"

// Read a pixel ahead of where they are used.
uint cost_ahead[kWords], sum_ahead[kWords];
int gray_ahead;

uint sum[kWords];  // what the volume holds of the pixel reached; 0 without `adds`

void load(ivec2 at) {
  gray_ahead = int(left_planes[p.left.offset + at.y * p.left.stride + at.x] & 0xFF);
  const int cell = (at.y * p.width + at.x) * p.words;
  for (int k = 0; k < kWords; ++k) {
    const bool there = word_of(k) < p.words;
    cost_ahead[k] = there ? costs[cell + word_of(k)] : 0xFFFFFFFF;
    sum_ahead[k] = there && p.adds != 0 ? volume[cell + word_of(k)] : 0;
  }
}

void store(ivec2 at) {
  const int cell = (at.y * p.width + at.x) * p.words;
  for (int k = 0; k < kWords; ++k)
    if (word_of(k) < p.words) volume[cell + word_of(k)] = pack(min(path[k] + unpack(sum[k]), kMost));
}

void walk(int line) {
  const int p2_least = int(costs[p.height * p.width * p.words]);
  const int steps = p.dy == 0 ? p.width : p.height;
  ivec2 at = p.dy == 0 ? ivec2(p.dx > 0 ? 0 : p.width - 1, line) : ivec2(line, p.dy > 0 ? 0 : p.height - 1);
  begin_path();
  load(at);
  int gray_before = gray_ahead;
  for (int i = 0; i < steps; ++i) {
    const ivec2 here = at;
    const int gray_here = gray_ahead;
    for (int k = 0; k < kWords; ++k) {
      cost[k] = cost_ahead[k];
      sum[k] = sum_ahead[k];
    }
    at += ivec2(p.dx, p.dy);
    const bool leaves = at.x < 0 || at.x >= p.width;
    if (leaves) at.x = at.x < 0 ? p.width - 1 : 0;
    if (i + 1 < steps) load(at);
    const int p2 = max(p2_least, p.p2 * p.p2_gradient / (p.p2_gradient + abs(gray_here - gray_before)));
    advance(uint(p.p1), uint(p2));
    store(here);
    gray_before = gray_here;
    if (leaves) begin_path();
  }
}

void main() {
  const int lines = p.dy == 0 ? p.height : p.width, stride = int(gl_NumWorkGroups.x * gl_NumSubgroups);
  for (int line = int(gl_WorkGroupID.x * gl_NumSubgroups + gl_SubgroupID); line < lines; line += stride) walk(line);
}
