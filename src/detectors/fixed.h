// Fixed-point arithmetic outside the networks: what a region depends on must have the same bits everywhere.
#pragma once

#include <cstdint>

namespace duo {

/// 1 / (1 + e^-x) in 1/32768, x in 1/128: correctly rounded entries for -16 .. 16, constant beyond.
std::uint16_t sigmoid_q15(std::int32_t x_q7);

/// `value` in 2^-from as the nearest in 2^-to; halves go up.
constexpr std::int32_t rescaled(std::int64_t value, int from, int to) {
  return static_cast<std::int32_t>(from <= to ? value * (std::int64_t{1} << (to - from))
                                              : (value + (std::int64_t{1} << (from - to - 1))) >> (from - to));
}

/// a / b as the nearest integer, halves up; b > 0.
constexpr std::int64_t rounded_quotient(std::int64_t a, std::int64_t b) {
  const std::int64_t twice = 2 * a + b;
  return twice / (2 * b) - (twice % (2 * b) < 0);
}

/// The root of n, rounded down; n >= 0.
constexpr std::int64_t integer_root(std::int64_t n) {
  std::int64_t root = 0;
  for (std::int64_t bit = std::int64_t{1} << 31; bit > 0; bit >>= 1)
    if ((root + bit) <= n / (root + bit)) root += bit;
  return root;
}

}  // namespace duo
