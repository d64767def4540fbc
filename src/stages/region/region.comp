#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#include "stages/region/region_params.h"

// Connected components by union-find over the windows' pixels in row-major order; each pixel's label is that of one before it in
// the same component, a root's its own. Five steps, each a dispatch, all tasks in each:
//   runs    each segment of kRegionLanes pixels finds its runs in bit masks: labels point to their first pixels
//   join    runs that touch those above, and those cut by segments, are united; the lower root wins, so that the last root left is
//           the component's first pixel, whatever the order of the atomics
//   count   labels become roots; runs add their lengths there
//   choose  each workgroup takes its best pixel
//   clear   all tasks' bits, a pixel of the picture at a time
// Moves about 40 bytes a pixel of each window (marks, labels and counts, written once and read three times) and 2 W H; 120
// operations a pixel. Atomics only where runs meet: a compact region of n rows has about n.
// Playne, Hawick, "A new algorithm for parallel connected-component labelling on GPUs", 2018 (joining by atomic minimum);
// Hennequin, Lacassagne, Cabaret, Meunier, "A new direct connected component labeling and analysis algorithm for GPUs", 2018
// (runs).
layout(local_size_x = kRegionLanes) in;
layout(std430, binding = 0) readonly buffer Tasks { RegionTask tasks[]; };
layout(std430, binding = 1) buffer Marks { uint8_t marks[]; };
// A task: room labels, room counts, then the key and the pixel of each workgroup's choice.
layout(std430, binding = 2) coherent buffer Forest { int forest[]; };
layout(std430, binding = 3) writeonly buffer Results { ivec2 results[]; };  // label, pixels
layout(push_constant) uniform Push { RegionPush p; };

const int kNone = -1, kFar = 0x7FFFFFFF;
const int kWords = kRegionLanes / 32;

shared uint breaks[kWords];  // bit set: the pixel does not go on with its left neighbour's run
shared uint best_key;
shared int best_pixel;
shared int chosen_label[kMostRegions];

RegionTask task;
ivec4 window;  // inside the picture: columns [x, z) of rows [y, w)
int wide, pixels, labels, counts, choices;

void open_task(int t) {
  task = tasks[t];
  window.xy = max(ivec2(task.x, task.y), ivec2(0));
  window.zw = max(min(ivec2(task.x_end, task.y_end), ivec2(p.width, p.height)), window.xy);
  wide = window.z - window.x;
  pixels = wide * (window.w - window.y);
  if (pixels > p.room) pixels = 0;
  labels = t * (2 * p.room + 2 * kRegionGroups);
  counts = labels + p.room;
  choices = counts + p.room;
}

ivec2 place_of(int pixel) { return window.xy + ivec2(pixel % wide, pixel / wide); }
int marks_index(ivec2 at) { return p.marks.offset + at.y * p.marks.stride + at.x; }

bool is_member(ivec2 at) { return (uint(marks[marks_index(at)]) >> task.bit & 1) != 0; }

// Whether two neighbours belong together; the one to the left or above may lie outside the window.
bool joined(ivec2 at, ivec2 before) {
  return before.x >= window.x && before.y >= window.y && is_member(at) && is_member(before);
}
bool joined_left(ivec2 at) { return joined(at, at - ivec2(1, 0)); }
bool joined_up(ivec2 at) { return joined(at, at - ivec2(0, 1)); }

int root_of(int pixel) {
  int up = forest[labels + pixel];
  while (up != pixel) {
    pixel = up;
    up = forest[labels + pixel];
  }
  return pixel;
}

void unite(int a, int b) {
  a = root_of(a);
  b = root_of(b);
  while (a != b) {
    const int high = max(a, b), low = min(a, b);
    const int before = atomicMin(forest[labels + high], low);
    if (before == high) return;  // it was a root and hangs below `low` now; else it hangs below something to unite with
    a = before;
    b = low;
  }
}

// Finds the breaks of this workgroup's segment.
void find_breaks(int lane, int pixel) {
  if (lane < kWords) breaks[lane] = 0;
  barrier();
  if (lane == 0 || pixel >= pixels || !joined_left(place_of(pixel))) atomicOr(breaks[lane / 32], 1u << lane % 32);
  barrier();
}

// The last break at or before a lane; lane 0 is one.
int break_before(int lane) {
  int word = lane / 32;
  uint bits = breaks[word] & 0xFFFFFFFFu >> (31 - lane % 32);
  while (bits == 0) bits = breaks[--word];
  return 32 * word + findMSB(bits);
}

// The first break after a lane, or the segment's end.
int break_after(int lane) {
  int word = lane / 32;
  uint bits = lane % 32 == 31 ? 0 : breaks[word] & 0xFFFFFFFFu << (lane % 32 + 1);
  while (bits == 0 && ++word < kWords) bits = breaks[word];
  return bits == 0 ? kRegionLanes : 32 * word + findLSB(bits);
}

void find_runs(int lane, int pixel) {
  find_breaks(lane, pixel);
  if (pixel >= pixels) return;
  forest[labels + pixel] = is_member(place_of(pixel)) ? pixel - lane + break_before(lane) : kNone;
  forest[counts + pixel] = 0;
}

void join_runs(int lane, int pixel) {
  if (pixel >= pixels) return;
  const ivec2 at = place_of(pixel);
  if (!is_member(at)) return;
  const bool left = joined_left(at);
  if (left && lane == 0) unite(pixel, pixel - 1);
  if (!joined_up(at)) return;
  // Where both rows go on from the left, the pixel there has united them already.
  if (left && joined_left(at - ivec2(0, 1)) && joined_up(at - ivec2(1, 0))) return;
  unite(pixel, pixel - wide);
}

void count_runs(int lane, int pixel) {
  find_breaks(lane, pixel);
  if (pixel >= pixels || forest[labels + pixel] == kNone) return;
  const int root = root_of(pixel);
  forest[labels + pixel] = root;
  if (break_before(lane) == lane) atomicAdd(forest[counts + root], break_after(lane) - lane);
}

// Smaller is better; the first pixel of several alike wins.
uint key_of(int pixel) {
  const ivec2 from = place_of(pixel) - ivec2(task.seed_x, task.seed_y);
  return uint(from.x * from.x) + uint(from.y * from.y);
}

void choose(int lane) {
  if (lane == 0) {
    best_key = 0xFFFFFFFFu;
    best_pixel = kFar;
  }
  barrier();
  uint key = 0xFFFFFFFFu;
  int best = kFar;
  for (int i = int(gl_GlobalInvocationID.x); i < pixels; i += kRegionGroups * kRegionLanes) {
    if (forest[labels + i] == kNone) continue;
    const uint here = key_of(i);
    if (here >= key) continue;
    key = here;
    best = i;
  }
  if (best != kFar) atomicMin(best_key, key);
  barrier();
  if (best != kFar && key == best_key) atomicMin(best_pixel, best);
  barrier();
  if (lane != 0) return;
  const int choice = choices + 2 * int(gl_WorkGroupID.x);
  forest[choice] = int(best_key);
  forest[choice + 1] = best_pixel;
}

// The best of all workgroups' choices as label and count.
ivec2 chosen_region() {
  uint key = 0xFFFFFFFFu;
  int best = kFar;
  for (int i = choices; i < choices + 2 * kRegionGroups; i += 2) {
    const uint here = uint(forest[i]);
    const int pixel = forest[i + 1];
    if (pixel == kFar || here > key || (here == key && pixel >= best)) continue;
    key = here;
    best = pixel;
  }
  if (best == kFar) return ivec2(kNone, 0);
  const int label = forest[labels + best];
  return ivec2(label, forest[counts + label]);
}

void clear(int lane, int i) {
  if (lane < p.tasks) {
    open_task(lane);
    const ivec2 region = chosen_region();
    chosen_label[lane] = region.x;
    const ivec2 first = region.x == kNone ? ivec2(0) : place_of(region.x);
    if (gl_WorkGroupID.x == 0)
      results[lane] = ivec2(region.x == kNone ? kNone : first.y * p.width + first.x, region.y);
  }
  barrier();
  if (i >= p.width * p.height) return;
  const ivec2 at = ivec2(i % p.width, i / p.width);
  const uint before = uint(marks[marks_index(at)]);
  uint after = before;
  for (int t = 0; t < p.tasks && before != 0; ++t) {
    open_task(t);
    if (at.x < window.x || at.y < window.y || at.x >= window.z || at.y >= window.w || pixels == 0) continue;
    const int label = forest[labels + (at.y - window.y) * wide + at.x - window.x];
    if (label == kNone || label != chosen_label[t]) after &= ~(1u << task.bit);
  }
  if (after != before) marks[marks_index(at)] = uint8_t(after);
}

void main() {
  const int lane = int(gl_LocalInvocationIndex), i = int(gl_GlobalInvocationID.x);
  if (p.step == kRegionClear) {
    clear(lane, i);
    return;
  }
  open_task(int(gl_WorkGroupID.y));
  if (p.step == kRegionChoose) {
    choose(lane);
    return;
  }
  if (i - lane >= pixels) return;
  if (p.step == kRegionRuns)
    find_runs(lane, i);
  else if (p.step == kRegionJoin)
    join_runs(lane, i);
  else
    count_runs(lane, i);
}
