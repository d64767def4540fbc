#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "stages/types/clear.h"
#include "stages/balance/balance_params.h"

// balance_table() from the sums of rows; one workgroup. The bounds that keep all this in 64 bits stand in balance_ref.cpp.
layout(local_size_x = kBalanceGroup) in;
layout(std430, binding = 0) readonly buffer Rows { uint rows[]; };  // [view][y][kBalanceSums]
layout(std430, binding = 1) writeonly buffer Table { uint table[256]; };
layout(std430, binding = 2) readonly buffer Clear { int known; };  // above 0: clear pictures
layout(push_constant) uniform Push { BalanceTablePush p; };

struct Sums {
  int64_t count, sum, squares;
};
shared int64_t partial[2 * kBalanceSums][kBalanceGroup];
shared int changes[kBalanceGroup];  // the largest of each invocation, then of all

uint64_t whole_root(uint64_t v) {
  uint64_t root = 0;
  for (int bit = 30; bit >= 0; --bit) {
    const uint64_t longer = root | uint64_t(1) << bit;
    if (longer * longer <= v) root = longer;
  }
  return root;
}

uint64_t deviation_q24(Sums s) {
  const uint64_t square = uint64_t(s.count * s.count);
  uint64_t rest = uint64_t(s.squares * s.count - s.sum * s.sum);
  uint64_t variance_q48 = rest / square;
  for (int i = 0; i < 3; ++i) {
    rest = rest % square << 16;
    variance_q48 = variance_q48 << 16 | rest / square;
  }
  return whole_root(variance_q48);
}

int64_t mean_q16(Sums s) { return ((s.sum << 16) + s.count / 2) / s.count; }

Sums total(int view) {
  return Sums(partial[view * kBalanceSums][0], partial[view * kBalanceSums + 1][0], partial[view * kBalanceSums + 2][0]);
}

int balanced(int64_t gain_q16, int64_t offset_q16, int v) {
  return int(clamp((gain_q16 * v + offset_q16 + (1 << 15)) >> 16, int64_t(0), int64_t(255)));
}

void main() {
  const int lane = int(gl_LocalInvocationIndex);
  for (int i = 0; i < 2 * kBalanceSums; ++i) {
    int64_t sum = 0;
    for (int y = lane; y < p.down; y += kBalanceGroup)
      sum += int64_t(rows[(i / kBalanceSums * p.down + y) * kBalanceSums + i % kBalanceSums]);
    partial[i][lane] = sum;
  }
  for (int half_of = kBalanceGroup / 2; half_of > 0; half_of /= 2) {
    barrier();
    if (lane < half_of)
      for (int i = 0; i < 2 * kBalanceSums; ++i) partial[i][lane] += partial[i][lane + half_of];
  }
  barrier();

  const Sums left = total(0), right = total(1);
  int64_t gain_q16 = 1 << 16, offset_q16 = 0;
  if (left.count >= kBalanceFewest) {
    const uint64_t from = deviation_q24(right), to = deviation_q24(left);
    if (from > 0 && to > 0) gain_q16 = int64_t(((to << 16) + from / 2) / from);
    offset_q16 = mean_q16(left) - ((gain_q16 * mean_q16(right) + (1 << 15)) >> 16);
  }
  changes[lane] = 0;
  for (int v = lane; v < 256; v += kBalanceGroup) changes[lane] = max(changes[lane], abs(balanced(gain_q16, offset_q16, v) - v));
  for (int half_of = kBalanceGroup / 2; half_of > 0; half_of /= 2) {
    barrier();
    if (lane < half_of) changes[lane] = max(changes[lane], changes[lane + half_of]);
  }
  barrier();
  int unbalanced = 0;
  if (p.looks != 0 && known > 0) unbalanced = kClearUnbalanced;
  const bool changed = changes[0] > unbalanced;
  for (int v = lane; v < 256; v += kBalanceGroup) table[v] = uint(changed ? balanced(gain_q16, offset_q16, v) : v);
}
