// A path that a subgroup walks: the path costs of the pixel it has reached, in registers. Word k gl_SubgroupSize + lane of the
// pixel is the lane's k-th; those behind the last disparity stay at 255, which no other cost is above and no path goes through.

layout(constant_id = 0) const int kWords = 1;  // of each lane, at the subgroup size that it is made for

const uint kMost = 255;

uvec4 path[kWords];
uint least;         // of all lanes
uint cost[kWords];  // C of the pixel that the path goes on to

uvec4 unpack(uint word) { return uvec4(word) >> uvec4(0, 8, 16, 24) & 0xFF; }
uint pack(uvec4 bytes) { return bytes.x | bytes.y << 8 | bytes.z << 16 | bytes.w << 24; }

int word_of(int k) { return k * int(gl_SubgroupSize) + int(gl_SubgroupInvocationID); }

// After this the next pixel's path costs are its costs alone.
void begin_path() {
  for (int k = 0; k < kWords; ++k) path[k] = uvec4(0);
  least = 0;
}

// To the pixel of `cost`: L = C + min(L', L' beside + p1, least L' + p2) - least L'. All lanes of a subgroup take part. Their words
// form a ring: what lane 0 gets from the last lane belongs to its next word, what the last lane gets from lane 0 to its word before.
void advance(uint p1, uint p2) {
  const uint lane = gl_SubgroupInvocationID, end = gl_SubgroupSize - 1;
  const uint before = (lane + end) & end, after = (lane + 1) & end;
  uint least_here = kMost, lower_wrapped = kMost, upper = subgroupShuffle(path[0].x, after);
  for (int k = 0; k < kWords; ++k) {
    const uvec4 old = path[k];
    const uint lower = subgroupShuffle(old.w, before);
    const uint upper_wrapped = k + 1 < kWords ? subgroupShuffle(path[min(k + 1, kWords - 1)].x, after) : kMost;
    const uvec4 below = uvec4(lane == 0 ? lower_wrapped : lower, old.xyz);
    const uvec4 above = uvec4(old.yzw, lane == end ? upper_wrapped : upper);
    const uvec4 best = min(min(old, min(below, above) + p1), least + p2);
    const uvec4 now = min(unpack(cost[k]) + best - least, kMost);
    least_here = min(least_here, min(min(now.x, now.y), min(now.z, now.w)));
    path[k] = now;
    lower_wrapped = lower;
    upper = upper_wrapped;
  }
  least = subgroupMin(least_here);
}
