// Times a stage on one picture, for the line that its test prints.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>

#include "duoptic/image.h"

namespace duo::test {

/// Prints the least of several runs, which other programs on the machine disturb least; never fails.
template <class F>
void print_time(const char* what, Size size, F&& run) {
  double least_ns = std::numeric_limits<double>::max();
  for (int i = 0; i < 15; ++i) {
    const auto start = std::chrono::steady_clock::now();
    run();
    least_ns = std::min(least_ns, std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count());
  }
  std::printf("%-34s %dx%d: %7.3f ns/pixel, %7.3f ms\n", what, size.width, size.height,
              least_ns / (double{1} * size.width * size.height), least_ns * 1e-6);
}

}  // namespace duo::test
