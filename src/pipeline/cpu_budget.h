// How many pairs of a live source are taken, where the CPU time of the process is limited.
#pragma once

#include <algorithm>
#include <cstdint>

namespace duo {

/// Lets a pair through while the process has used no more CPU time than it may: time that is saved counts for a tenth of a
/// second, time that is owed for a second, so that after a standstill neither a burst nor a long pause follows. A pair a second
/// comes through in any case.
class CpuBudget {
 public:
  /// `cores`: CPU time per wall time that the process may take; 0: as much as it wants.
  explicit CpuBudget(double cores) : cores_(cores) {}

  /// Whether a pair that comes now is taken; both clocks only grow.
  bool allows(std::int64_t wall_ns, std::int64_t cpu_ns) {
    if (cores_ <= 0) return true;
    if (begun_) {
      const double used = static_cast<double>(cpu_ns - cpu_ns_) - cores_ * static_cast<double>(wall_ns - wall_ns_);
      owed_ns_ = std::clamp(owed_ns_ + used, -cores_ * kSaved_ns, cores_ * kSecond_ns);
    }
    wall_ns_ = wall_ns;
    cpu_ns_ = cpu_ns;
    if (begun_ && owed_ns_ > 0 && static_cast<double>(wall_ns - taken_ns_) < kSecond_ns) return false;
    begun_ = true;
    taken_ns_ = wall_ns;
    return true;
  }

 private:
  static constexpr double kSecond_ns = 1e9, kSaved_ns = 1e8;
  double cores_;
  bool begun_ = false;
  double owed_ns_ = 0;                     // of CPU time; below 0: saved
  std::int64_t wall_ns_ = 0, cpu_ns_ = 0;  // both clocks at the last pair
  std::int64_t taken_ns_ = 0;              // wall clock at the last pair that was taken
};

}  // namespace duo
