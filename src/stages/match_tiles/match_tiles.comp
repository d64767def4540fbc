#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/match_tiles/match_tiles_params.h"

// One workgroup a tile, one candidate after the other for all of its pixels, two barriers a candidate:
//   1. a column of pixel costs an invocation, summed down seven rows as it goes      -> columns
//   2. eight windows of a row an invocation, summed along x, the least of the shifts -> shifted
//   3. the least of three rows. Winners stay in registers; the right view's go to memory by atomicMin on cost << 16 | d, which
//      takes the smallest d of equals whatever the order.
// A pixel and candidate: 2.5 pixel costs of 20 operations, 2.5 * 2 for the columns, 1.8 * 2 + 4.7 for the windows, 12 for the
// winner: about 75 operations, 8 accesses of shared memory, 20 bytes from the cache, one atomic. Memory: 12 bytes of channels a
// pixel, 4 of results, 4 to 8 of the right view.
layout(local_size_x = kTileGroup) in;
layout(std430, binding = 0) readonly buffer LeftWords { uint left_words[]; };
layout(std430, binding = 1) readonly buffer RightWords { uvec2 right_words[]; };
layout(std430, binding = 2) readonly buffer Sets { uint sets[]; };
layout(std430, binding = 3) buffer RightBest { uint right_best[]; };
layout(std430, binding = 4) writeonly buffer Left { int16_t left[]; };
layout(std430, binding = 5) writeonly buffer Fine { uint16_t fine[]; };
layout(push_constant) uniform Push { MatchTilesPush p; };

const int kWindow = 7;
const int kColumns = kTilePixelsX + 2 * (3 + 3), kRows = kTilePixelsY + 2 * 2;  // of costs; of windows
const int kParts = kTileGroup / kColumns, kPartRows = kRows / kParts;           // each column is cut in so many parts
const int kCosts = kPartRows + kWindow - 1;                                     // pixels of one part
const int kSegment = 8, kSums = kSegment + kWindow - 1;                         // windows of an invocation; with their shifts
// Odd pitches: neighbouring rows lie in different banks.
const int kColumnPitch = kColumns + 1, kShiftedPitch = kTilePixelsX + 1;
shared int columns[kRows * kColumnPitch];
shared int shifted[kRows * kShiftedPitch];

const int kPixels = kTilePixelsX * kTilePixelsY / kTileGroup;  // of one invocation
const int kNoCost = 0x7FFF;
// Loops over these are unrolled, so that they are registers.
uint left_costs[kCosts];  // channels of the invocation's column of the left picture
int best[kPixels], winner[kPixels], before[kPixels], after[kPixels], previous[kPixels];

ivec2 tile_corner() { return ivec2(gl_WorkGroupID.xy) * ivec2(kTilePixelsX, kTilePixelsY); }
ivec2 column_top(int me) { return tile_corner() + ivec2(me % kColumns - 6, me / kColumns * kPartRows - 5); }
int row_start(int y) { return clamp(y, 0, p.height - 1) * p.width; }

int channel(uint word, int i) { return int(word >> (8 * i) & 0xFF); }

int pixel_cost(uint l, uvec2 r) {
  const int gray = abs(channel(l, 0) - channel(r.x, 0));
  const int across = max(max(channel(l, 1) - channel(r.x, 2), channel(r.x, 1) - channel(l, 1)), 0);
  const int along = max(max(channel(l, 2) - channel(r.y, 1), channel(r.y, 0) - channel(l, 2)), 0);
  return min(gray, p.truncation) + min(across, p.truncation) + min(along, p.truncation);
}

void sum_columns(int me, int d) {
  if (me >= kParts * kColumns) return;
  const ivec2 top = column_top(me);
  const int x = clamp(top.x - d, 0, p.width - 1);
  int costs[kCosts], sum = 0;
  [[unroll]] for (int i = 0; i < kCosts; ++i) {
    costs[i] = pixel_cost(left_costs[i], right_words[row_start(top.y + i) + x]);
    sum += costs[i];
    if (i >= kWindow) sum -= costs[i - kWindow];
    if (i >= kWindow - 1) columns[(me / kColumns * kPartRows + i - (kWindow - 1)) * kColumnPitch + me % kColumns] = sum;
  }
}

// Windows centred outside the picture do not count.
void shift_windows(int me) {
  const int row = me % kRows, first = me / kRows * kSegment;
  if (first >= kTilePixelsX) return;
  const ivec2 centre = tile_corner() + ivec2(first - 3, row - 2);  // of sums[0]
  int sums[kSums], column[kSums + kWindow - 1], sum = 0;
  const bool in_picture = centre.y >= 0 && centre.y < p.height;
  [[unroll]] for (int i = 0; i < kSums + kWindow - 1; ++i) {
    column[i] = columns[row * kColumnPitch + first + i];
    sum += column[i];
    if (i >= kWindow) sum -= column[i - kWindow];
    const int at = i - (kWindow - 1);
    if (at >= 0) sums[at] = in_picture && centre.x + at >= 0 && centre.x + at < p.width ? sum : kNoCost;
  }
  [[unroll]] for (int i = 0; i < kSegment; ++i)
    shifted[row * kShiftedPitch + first + i] = p.reach == 3 ? min(min(sums[i], sums[i + 2]), min(sums[i + 4], sums[i + 6]))
                                                            : min(min(sums[i + 1], sums[i + 3]), sums[i + 5]);
}

// `follows`: the candidate before this one was d - 1.
void choose(int me, int d, bool follows) {
  [[unroll]] for (int k = 0; k < kPixels; ++k) {
    const int i = me + k * kTileGroup, y = i / kTilePixelsX, x = i % kTilePixelsX, s = y * kShiftedPitch + x;
    const ivec2 at = tile_corner() + ivec2(x, y);
    if (at.x < d || at.x >= p.width || at.y >= p.height) continue;
    const int cost = min(min(shifted[s], shifted[s + 2 * kShiftedPitch]), shifted[s + 4 * kShiftedPitch]);
    if (follows && winner[k] == d - 1) after[k] = cost;
    if (cost < best[k]) {
      best[k] = cost;
      winner[k] = d;
      before[k] = follows ? previous[k] : kNoCost;
      after[k] = kNoCost;
    }
    previous[k] = cost;
    if (cost != kNoCost) atomicMin(right_best[at.y * p.width + at.x - d], uint(cost) << 16 | uint(d));
  }
}

// Offset in 1/16 px of the tip of a V through three costs.
int sub_pixel(int before, int best, int after) {
  const int height = max(before, after) - best;
  if (before == kNoCost || after == kNoCost || height == 0) return 0;
  const int offset = (8 * abs(before - after) + height / 2) / height;
  return before >= after ? offset : -offset;
}

void write_winners(int me) {
  [[unroll]] for (int k = 0; k < kPixels; ++k) {
    const int i = me + k * kTileGroup;
    const ivec2 at = tile_corner() + ivec2(i % kTilePixelsX, i / kTilePixelsX);
    if (at.x >= p.width || at.y >= p.height) continue;
    left[p.left.offset + at.y * p.left.stride + at.x] = int16_t(winner[k]);
    const int q4 = 16 * winner[k] + sub_pixel(before[k], best[k], after[k]);
    fine[p.fine.offset + at.y * p.fine.stride + at.x] = uint16_t(winner[k] < 0 ? 0xFFFF : q4);
  }
}

void main() {
  const int me = int(gl_LocalInvocationIndex);
  const ivec2 top = column_top(me);
  [[unroll]] for (int i = 0; i < kCosts; ++i) left_costs[i] = left_words[row_start(top.y + i) + clamp(top.x, 0, p.width - 1)];
  [[unroll]] for (int k = 0; k < kPixels; ++k) {
    best[k] = before[k] = after[k] = previous[k] = kNoCost;
    winner[k] = -1;
  }

  const int set = p.sets.offset + int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * p.sets.stride;
  const int end = min(p.max_disparity, min(tile_corner().x + kTilePixelsX, p.width));  // no pixel has x >= d beyond
  int last = -2;
  for (int word = 0; 32 * word < end; ++word)
    for (uint bits = p.all_candidates != 0 ? 0xFFFFFFFFu : sets[set + word]; bits != 0; bits &= bits - 1) {
      const int d = 32 * word + findLSB(bits);
      if (d >= end) break;
      sum_columns(me, d);
      barrier();
      shift_windows(me);
      barrier();
      choose(me, d, d == last + 1);
      last = d;
    }
  write_winners(me);
}
