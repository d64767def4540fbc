// Order statistics. All of them reorder the values that they are given.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <span>

namespace [[gnu::visibility("default")]] duo {

/// The value at place `rank`, counted from 0, of all values in order.
template <class Values>
auto& nth(Values&& values, std::size_t rank) {
  const auto at = std::begin(values) + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(std::begin(values), at, std::end(values));
  return *at;
}

/// The value at n / 2: of an even number the upper one of the two in the middle.
template <class Values>
auto median(Values&& values) {
  return nth(values, std::size(values) / 2);
}

/// The value at share (n - 1), rounded down: 0 the least, 1 the greatest.
template <class Values>
auto quantile(Values&& values, double share) {
  return nth(values, static_cast<std::size_t>(share * static_cast<double>(std::size(values) - 1)));
}

}  // namespace duo
