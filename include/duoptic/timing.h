// Wall and CPU time of a call, and medians of them.
#pragma once

#include <ctime>
#include <utility>
#include <vector>

#include "duoptic/statistics.h"

namespace [[gnu::visibility("default")]] duo {

struct Times {
  double wall_ms = 0, cpu_ms = 0;  // CPU: of all threads of the process
};

/// Of one of the system's clocks.
inline double clock_ms(clockid_t id) {
  timespec t{};
  clock_gettime(id, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) / 1e6;
}

template <class F>
Times timed(F&& call) {
  const double wall = clock_ms(CLOCK_MONOTONIC), cpu = clock_ms(CLOCK_PROCESS_CPUTIME_ID);
  call();
  return {clock_ms(CLOCK_MONOTONIC) - wall, clock_ms(CLOCK_PROCESS_CPUTIME_ID) - cpu};
}

/// The median; 0 of nothing.
inline double median_of(std::vector<double> values) { return values.empty() ? 0 : median(values); }
inline Times median_of(const std::vector<Times>& runs) {
  std::vector<double> wall, cpu;
  for (const Times& t : runs) {
    wall.push_back(t.wall_ms);
    cpu.push_back(t.cpu_ms);
  }
  return {median_of(std::move(wall)), median_of(std::move(cpu))};
}

}  // namespace duo
