#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "stages/match_points/match_points_params.h"

// A workgroup a stored point, an invocation a candidate. S stored and N seen points: 128 S N bytes, all but the first few from the
// cache, and about 640 S N operations; the mutual check the same for S stored against the matched ones.
const int kLanes = 128;
layout(local_size_x = kLanes) in;
layout(std430, binding = 0) readonly buffer Stored { uint stored[]; };
layout(std430, binding = 1) readonly buffer Seen { uint seen[]; };
layout(std430, binding = 2) readonly buffer Predicted { vec2 predicted_px[]; };
layout(std430, binding = 3) buffer Matches { ivec2 matches[]; };  // duo::PointMatch: seen, square distance
layout(push_constant) uniform Push { MatchPointsPush p; };

const int kNone = -1, kFar = 0x7FFFFFFF;

shared uint fixed_words[kSiftDescriptorWords];
shared int best_distance, best_index, second_distance;
shared int refused;

int list() { return int(gl_WorkGroupID.y); }
int stored_count() { return min(int(stored[sift_head(list())]), p.stored.capacity); }
int seen_count() { return min(int(seen[sift_head(list())]), p.seen.capacity); }

// Of four bytes.
int square_step(uint a, uint b) {
  int sum = 0;
  for (int shift = 0; shift < 32; shift += 8) {
    const int d = int(a >> shift & 255) - int(b >> shift & 255);
    sum += d * d;
  }
  return sum;
}

bool within(int i, int j) {
  const int at = sift_point(p.seen, list(), j);
  precise const vec2 d = uintBitsToFloat(uvec2(seen[at], seen[at + 1])) - predicted_px[list() * p.stored.capacity + i];
  precise const float square = d.x * d.x + d.y * d.y;
  return square <= p.square_reach_px;
}

// kFar where j is no candidate of i; one of their descriptors is in fixed_words.
int distance_from_stored(int i, int j) {
  if (p.gated != 0 && !within(i, j)) return kFar;
  const int at = sift_descriptor(p.seen, list(), j);
  int sum = 0;
  for (int k = 0; k < kSiftDescriptorWords; ++k) sum += square_step(fixed_words[k], seen[at + k]);
  return sum;
}
int distance_from_seen(int i, int j) {
  if (p.gated != 0 && !within(i, j)) return kFar;
  const int at = sift_descriptor(p.stored, list(), i);
  int sum = 0;
  for (int k = 0; k < kSiftDescriptorWords; ++k) sum += square_step(fixed_words[k], stored[at + k]);
  return sum;
}

void find_nearest(int lane, int i) {
  int best = kFar, index = kNone, second = kFar;  // of this invocation's candidates
  const int count = seen_count();
  for (int j = lane; j < count; j += kLanes) {
    const int d = distance_from_stored(i, j);
    if (d < best) {
      second = best;
      best = d;
      index = j;
    } else {
      second = min(second, d);
    }
  }
  atomicMin(best_distance, best);
  barrier();
  if (index != kNone && best == best_distance) atomicMin(best_index, index);
  barrier();
  atomicMin(second_distance, index == best_index ? second : best);
  barrier();
  if (lane != 0) return;
  const int64_t share = int64_t(p.ratio_percent) * p.ratio_percent;
  const bool good =
      best_distance != kFar && (second_distance == kFar || int64_t(best_distance) * 10000 < share * second_distance);
  matches[list() * p.stored.capacity + i] = good ? ivec2(best_index, best_distance) : ivec2(kNone, 0);
}

void check_mutual(int lane, int i, ivec2 match) {
  const int count = stored_count();
  for (int k = lane; k < count; k += kLanes) {
    const int d = distance_from_seen(k, match.x);
    if (d < match.y || (d == match.y && k < i)) atomicOr(refused, 1);
  }
  barrier();
  if (lane == 0 && refused != 0) matches[list() * p.stored.capacity + i] = ivec2(kNone, 0);
}

void main() {
  const int lane = int(gl_LocalInvocationIndex), i = int(gl_WorkGroupID.x), to = list() * p.stored.capacity + i;
  if (i >= stored_count()) {
    if (lane == 0) matches[to] = ivec2(kNone, 0);
    return;
  }
  ivec2 match = ivec2(kNone, 0);
  if (p.mutual != 0) {
    match = matches[to];
    if (match.x == kNone) return;
  }
  if (lane == 0) {
    best_distance = best_index = second_distance = kFar;
    refused = 0;
  }
  if (lane < kSiftDescriptorWords)
    fixed_words[lane] = p.mutual != 0 ? seen[sift_descriptor(p.seen, list(), match.x) + lane]
                                      : stored[sift_descriptor(p.stored, list(), i) + lane];
  barrier();
  if (p.mutual != 0)
    check_mutual(lane, i, match);
  else
    find_nearest(lane, i);
}
