#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/sift/sift_params.h"
#include "stages/sift/sift_space.glsl"

// The three lists of a window, each in order and made by one workgroup: candidates from their bits, places that are kept, points
// from the angles of places. Reads the bits, a word for 32 positions; the rest are a few words a candidate.
layout(local_size_x = kSiftLanes) in;
layout(std430, binding = 0) readonly buffer Claims { uint claims[]; };
layout(std430, binding = 1) buffer Work { uint work[]; };
layout(std430, binding = 2) buffer Groups { uint groups[]; };
layout(std430, binding = 3) writeonly buffer Points { uint points[]; };
layout(push_constant) uniform Push { SiftPointPush p; };

const int kMostOctaves = 8;
shared int lane_counts[kSiftLanes];
shared uint good[kSiftMostCandidates / 32 + 1];
shared int octave_first[kMostOctaves + 1], octave_kept[kMostOctaves + 1];

SiftWork lists;
int first_word;

// How many the invocations before this one have, and all.
ivec2 counted_before(int lane, int count) {
  lane_counts[lane] = count;
  barrier();
  ivec2 sum = ivec2(0);
  for (int i = 0; i < kSiftLanes; ++i) {
    if (i < lane) sum.x += lane_counts[i];
    sum.y += lane_counts[i];
  }
  return sum;
}

void list_candidates(int lane) {
  const int words = lists.candidates - lists.bits, share = (words + kSiftLanes - 1) / kSiftLanes;
  const int begin = min(lane * share, words), end = min(begin + share, words);
  int count = 0;
  for (int i = begin; i < end; ++i) count += bitCount(work[first_word + lists.bits + i]);
  const ivec2 before = counted_before(lane, count);
  int to = before.x;
  for (int i = begin; i < end; ++i) {
    uint bits = work[first_word + lists.bits + i];
    for (; bits != 0; bits &= bits - 1, ++to)
      if (to < p.shape.candidates) work[first_word + lists.candidates + to] = 32 * i + findLSB(bits);
  }
  if (lane != 0) return;
  const int listed = min(before.y, p.shape.candidates);
  work[first_word] = listed;
  work[first_word + 1] = before.y - listed;
  atomicMax(groups[kSiftRefineGroups], (listed + kSiftRefineLanes - 1) / kSiftRefineLanes);
}

// Whether a candidate became a place that no other has.
bool is_good(int window, int i) {
  const int place = first_word + lists.places + i * kSiftPlaceWords;
  const uint state = work[place + 6];
  if (state != kSiftMoved) return state == kSiftStays;
  return claims[window * positions_in(p.shape) + int(work[place + 7])] == uint(i) + 1;
}

// Good ones before candidate i.
int good_before(int i) {
  int count = 0;
  for (int word = 0; word < i / 32; ++word) count += bitCount(good[word]);
  return i % 32 == 0 ? count : count + bitCount(good[i / 32] << (32 - i % 32));
}

void list_places(int lane, int window) {
  const int candidates = int(work[first_word]);
  for (int i = lane; i <= candidates / 32; i += kSiftLanes) good[i] = 0;
  if (lane <= kMostOctaves) octave_first[lane] = candidates;
  barrier();
  for (int i = lane; i < candidates; i += kSiftLanes) {
    if (!is_good(window, i)) continue;
    atomicOr(good[i / 32], 1u << i % 32);
    const int octave = int(work[first_word + lists.places + i * kSiftPlaceWords + 4]);
    for (int k = 0; k <= octave; ++k) atomicMin(octave_first[k], i);
  }
  barrier();
  // An octave keeps no more than there may be points; octave_first becomes the good ones before it.
  if (lane == 0) {
    int kept = 0, overflow = 0;
    for (int k = 0; k <= kMostOctaves; ++k) octave_first[k] = good_before(octave_first[k]);
    for (int k = 0; k < kMostOctaves; ++k) {
      octave_kept[k] = kept;
      const int count = octave_first[k + 1] - octave_first[k], room = min(count, p.shape.capacity);
      kept += room;
      overflow += count - room;
    }
    work[first_word + 1] += overflow;
    work[first_word + 2] = kept;
    atomicMax(groups[kSiftOrientGroups], kept);
  }
  barrier();
  for (int i = lane; i < candidates; i += kSiftLanes) {
    if ((good[i / 32] >> i % 32 & 1) == 0) continue;
    const int octave = int(work[first_word + lists.places + i * kSiftPlaceWords + 4]);
    const int rank = good_before(i) - octave_first[octave];
    if (rank < p.shape.capacity) work[first_word + lists.kept + octave_kept[octave] + rank] = i;
  }
}

void list_points(int lane, int window) {
  const int kept = int(work[first_word + 2]), share = (kept + kSiftLanes - 1) / kSiftLanes;
  const int begin = min(lane * share, kept), end = min(begin + share, kept);
  int count = 0;
  for (int i = begin; i < end; ++i)
    count += int(work[first_word + lists.places + int(work[first_word + lists.kept + i]) * kSiftPlaceWords + 8]);
  const ivec2 before = counted_before(lane, count);
  int to = before.x;
  for (int i = begin; i < end; ++i) {
    const uint place = work[first_word + lists.kept + i];
    const int angles = int(work[first_word + lists.places + int(place) * kSiftPlaceWords + 8]);
    for (int angle = 0; angle < angles; ++angle, ++to)
      if (to < p.shape.capacity) work[first_word + lists.points + to] = place * kSiftMostAngles + angle;
  }
  if (lane != 0) return;
  const int listed = min(before.y, p.shape.capacity);
  points[sift_head(window)] = listed;
  points[sift_head(window) + 1] = work[first_word + 1] + before.y - listed;
  atomicMax(groups[kSiftDescribeGroups], listed);
}

void main() {
  const int lane = int(gl_LocalInvocationIndex), window = int(gl_WorkGroupID.y);
  lists = sift_work(p.shape);
  first_word = window * lists.words;
  if (p.step == kSiftCandidates)
    list_candidates(lane);
  else if (p.step == kSiftPlaces)
    list_places(lane, window);
  else
    list_points(lane, window);
}
