#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#include "stages/sample_depth/sample_depth_params.h"

// Radix selection: the high bytes of the wanted values from one histogram, the low bytes from another beside each of them.
// Reads up to 3 bytes a pixel of each area, twice; about 20 operations and one atomic in shared memory a pixel each time.
layout(local_size_x = kAreaLanes) in;

// duo::DepthSample
struct DepthSample {
  int count, known;
  uint lower_median_q4, upper_q4;  // two halves of a word, the lower first; one and padding
};

layout(std430, binding = 0) readonly buffer Areas { DeviceArea areas[]; };
layout(std430, binding = 1) readonly buffer Disparity { uint16_t d_q4[]; };
layout(std430, binding = 2) readonly buffer Marks { uint8_t marks[]; };
layout(std430, binding = 3) buffer Counts { uint counts[]; };  // kDepthCounts an area, 0 at first
layout(std430, binding = 4) writeonly buffer Results { DepthSample results[]; };
layout(push_constant) uniform Push { SampleDepthPush p; };

const uint kNone = 0xFFFF;
const int kParts = 16, kPartBins = kDepthBins / kParts;

shared uint bins[kDepthRanks * kDepthBins];
shared uint part_sums[kDepthRanks * kParts];
shared uint all;

int index(Plane plane, ivec2 at) { return plane.offset + at.y * plane.stride + at.x; }

// A bin and the rank within it.
struct Found {
  int bin;
  uint rank;
};

// Loads a histogram for each rank from counts[first + stride * rank].
void load_bins(int first, int stride) {
  const int lane = int(gl_LocalInvocationIndex);
  for (int i = lane; i < kDepthRanks * kDepthBins; i += kAreaLanes)
    bins[i] = counts[first + i / kDepthBins * stride + i % kDepthBins];
  barrier();
  if (lane < kDepthRanks * kParts) {
    uint sum = 0;
    for (int i = 0; i < kPartBins; ++i) sum += bins[lane * kPartBins + i];
    part_sums[lane] = sum;
  }
  barrier();
}

uint total_of(int rank_index) {
  uint sum = 0;
  for (int i = 0; i < kParts; ++i) sum += part_sums[rank_index * kParts + i];
  return sum;
}

// In the histogram of one rank: the bin that holds the value with this many before it, of which there is one.
Found find_bin(int rank_index, uint rank) {
  int part = rank_index * kParts;
  for (; rank >= part_sums[part]; ++part) rank -= part_sums[part];
  int bin = part * kPartBins;
  for (; rank >= bins[bin]; ++bin) rank -= bins[bin];
  return Found(bin - rank_index * kDepthBins, rank);
}

uint rank_of(int rank_index, uint known) {
  const uint last = known - 1;
  return rank_index == 0 ? last / 4 : rank_index == 1 ? last / 2 : 3 * last / 4;
}

// Counts this workgroup's share of the area's pixels into bins; `high` are the bytes beside which low ones count, when they do.
void count_pixels(DeviceArea area, ivec3 high) {
  const ivec4 bounds = bounds_of(area, ivec2(p.width, p.height));
  const int wide = bounds.z - bounds.x, pixels = wide * (bounds.w - bounds.y);
  for (int i = int(gl_GlobalInvocationID.x); i < pixels; i += kAreaGroups * kAreaLanes) {
    const ivec2 at = bounds.xy + ivec2(i % wide, i / wide);
    if (!in_disc(area, at)) continue;
    if (p.with_marks != 0 && (int(marks[index(p.marks, at)]) & area.bits) == 0) continue;
    const uint d = uint(d_q4[index(p.d, at)]);
    if (p.step == kCountHigh) atomicAdd(all, 1);
    if (d == kNone) continue;
    if (p.step == kCountHigh) {
      atomicAdd(bins[d >> 8], 1);
      continue;
    }
    for (int r = 0; r < kDepthRanks; ++r)
      if (high[r] == int(d >> 8)) atomicAdd(bins[r * kDepthBins + int(d & 255)], 1);
  }
}

shared int wanted_high[kDepthRanks];
shared uint wanted_rank[kDepthRanks];
shared uint low[kDepthRanks];

void main() {
  const int lane = int(gl_LocalInvocationIndex), base = int(gl_WorkGroupID.y) * kDepthCounts;
  uint known = 0;
  if (p.step != kCountHigh) {
    load_bins(base, 0);
    known = total_of(0);
    if (known > 0 && lane < kDepthRanks) {
      const Found found = find_bin(lane, rank_of(lane, known));
      wanted_high[lane] = found.bin;
      wanted_rank[lane] = found.rank;
    }
    barrier();
  }
  if (p.step == kSelect) {
    load_bins(base + kDepthLow, kDepthBins);
    if (known > 0 && lane < kDepthRanks) low[lane] = uint(find_bin(lane, wanted_rank[lane]).bin);
    barrier();
    if (lane != 0) return;
    DepthSample result;
    result.count = int(counts[base + kDepthAll]);
    result.known = int(known);
    uint value_q4[kDepthRanks];
    for (int r = 0; r < kDepthRanks; ++r) value_q4[r] = known > 0 ? uint(wanted_high[r]) << 8 | low[r] : kNone;
    result.lower_median_q4 = value_q4[0] | value_q4[1] << 16;
    result.upper_q4 = value_q4[2];
    results[gl_WorkGroupID.y] = result;
    return;
  }

  for (int i = lane; i < kDepthRanks * kDepthBins; i += kAreaLanes) bins[i] = 0;
  if (lane == 0) all = 0;
  barrier();
  const bool counting = p.step == kCountHigh || known > 0;
  if (counting)
    count_pixels(areas[gl_WorkGroupID.y], ivec3(wanted_high[0], wanted_high[1], wanted_high[2]));
  barrier();
  const int to = base + (p.step == kCountHigh ? 0 : kDepthLow);
  const int used = p.step == kCountHigh ? kDepthBins : kDepthRanks * kDepthBins;
  for (int i = lane; i < used; i += kAreaLanes)
    if (bins[i] != 0) atomicAdd(counts[to + i], bins[i]);
  if (lane == 0 && all > 0) atomicAdd(counts[base + kDepthAll], all);
}
