#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/tile_candidates/tile_candidates_params.h"

// Moves 2 bytes a coarse pixel (1.4 reads with the footprints' overlap), and the sets; 8 operations and one shared atomic a read.
// Tiles where nothing passed the check read 7 times as much, from the cache.
layout(local_size_x = kCandidatesGroup) in;
layout(std430, binding = 0) readonly buffer Checked { int16_t checked[]; };
layout(std430, binding = 1) readonly buffer Unchecked { int16_t unchecked[]; };
layout(std430, binding = 2) writeonly buffer Sets { uint sets[]; };
layout(push_constant) uniform Push { TileCandidatesPush p; };

const int kAttempts = 3;  // checked nearby, checked around, unchecked around
shared uint set[kCandidatesMaxWords];
shared uint voted[kAttempts];

int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }

// Adds 2 d - margin .. 2 d + 1 + margin: at most 32 bits, so they lie in two words.
void vote(int d) {
  const int first = max(2 * d - p.margin, 0), last = min(2 * d + 1 + p.margin, p.max_disparity - 1);
  if (first > last) return;
  const uint bits = 0xFFFFFFFFu >> (31 - (last - first));
  atomicOr(set[first / 32], bits << (first % 32));
  if (last / 32 != first / 32) atomicOr(set[last / 32], bits >> (32 - first % 32));
}

void main() {
  const int me = int(gl_LocalInvocationIndex), words = (p.max_disparity + 31) / 32;
  const ivec2 tile = ivec2(gl_WorkGroupID.xy), tile_size = ivec2(p.tile_width, p.tile_height);
  for (int i = me; i < words; i += kCandidatesGroup) set[i] = 0;
  if (me < kAttempts) voted[me] = 0;
  barrier();
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const ivec2 grow = p.grow + (attempt == 0 ? ivec2(0) : tile_size);
    const ivec2 from = max(tile * tile_size - grow, ivec2(0));
    const ivec2 area = min((tile + 1) * tile_size + grow, ivec2(p.width, p.height)) - from;
    uint found = 0;
    for (int i = me; i < area.x * area.y; i += kCandidatesGroup) {
      const ivec2 at = from + ivec2(i % area.x, i / area.x);
      const int d = attempt < 2 ? int(checked[index(p.checked, at)]) : int(unchecked[index(p.unchecked, at)]);
      if (d < 0) continue;
      found = 1;
      vote(d);
    }
    if (found != 0) atomicOr(voted[attempt], 1);
    barrier();
    if (voted[attempt] != 0) break;
  }
  const int row = p.sets.offset + (tile.y * int(gl_NumWorkGroups.x) + tile.x) * p.sets.stride;
  for (int i = me; i < words; i += kCandidatesGroup) sets[row + i] = set[i];
}
