// Wall and CPU clocks, and the timer that fills Frame::stages.
#pragma once

#include <cstring>
#include <ctime>
#include <span>

#include "core/check.h"
#include "duoptic/frame.h"

namespace duo {

inline std::int64_t clock_ns(clockid_t id) {
  timespec t{};
  clock_gettime(id, &t);
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}
inline std::int64_t wall_ns() { return clock_ns(CLOCK_MONOTONIC); }
inline std::int64_t cpu_ns() { return clock_ns(CLOCK_PROCESS_CPUTIME_ID); }

/// Adds to the time of a stage; further stages than the array holds are left out.
inline void add_time(std::span<StageTime> times, const char* stage, std::int64_t wall_ns, std::int64_t cpu_ns) {
  for (StageTime& t : times) {
    if (t.wall_ns != 0 && std::strcmp(t.stage, stage) != 0) continue;
    t.stage = stage;
    t.wall_ns += wall_ns > 0 ? wall_ns : 1;
    t.cpu_ns += cpu_ns;
    return;
  }
}

/// Adds up the time of each stage of a frame; does nothing while off.
class StageTimer {
 public:
  using Times = decltype(Frame::stages);
  void start(Times& times, bool on) {
    times_ = on ? &times : nullptr;
    times = {};
    if (on) mark();
  }
  /// Ends the stage that ran since the last call.
  void stage(const char* name) {
    if (times_ == nullptr) return;
    add_time(*times_, name, wall_ns() - wall_, cpu_ns() - cpu_);
    mark();
  }

 private:
  void mark() {
    wall_ = wall_ns();
    cpu_ = cpu_ns();
  }
  Times* times_ = nullptr;
  std::int64_t wall_ = 0, cpu_ = 0;
};

}  // namespace duo
