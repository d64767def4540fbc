#include "sources/camera/clock_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "duoptic/statistics.h"

namespace duo {
namespace {

constexpr double kLeastJitter_ns = 0.2e6;  // below that a stamp is right, and the gate would close on rounding
constexpr double kGate = 4;                // standard deviations
constexpr int kMostOff = 3;

}  // namespace

TimeNs ClockModel::capture_ns(std::int64_t number, TimeNs stamp_ns) {
  const Stamp stamp{number, stamp_ns};
  if (count_ == 0 || number <= last_number_ || !agrees(stamp)) start(stamp);
  last_number_ = number;
  stamps_[count_++ % kMost] = stamp;
  if (count_ >= kLeast) fit();
  const TimeNs t_ns = count_ >= kLeast ? origin_.t_ns + std::llround(line_ns(number)) : stamp_ns;
  given_ns_ = std::max(given_ns_ + 1, t_ns);  // time never goes back, not even where a fit starts again
  return given_ns_;
}

void ClockModel::start(const Stamp& stamp) {
  origin_ = stamp;
  count_ = 0;
  off_ = 0;
  offset_ns_ = jitter_ns_ = 0;
  rate_ = 1;
}

double ClockModel::line_ns(std::int64_t number) const {
  return offset_ns_ + rate_ * frame_ns_ * static_cast<double>(number - origin_.number);
}

/// False when the camera no longer keeps to the line.
bool ClockModel::agrees(const Stamp& stamp) {
  if (count_ < kLeast) return true;
  const double off_ns = static_cast<double>(stamp.t_ns - origin_.t_ns) - line_ns(stamp.number);
  const double gate_ns = kGate * std::max(jitter_ns_, kLeastJitter_ns);
  if (std::abs(off_ns) <= gate_ns)
    off_ = 0;
  else if (off_ns > 0)
    off_ = std::max(off_, 0) + 1;
  else
    off_ = std::min(off_, 0) - 1;
  return std::abs(off_) < kMostOff;
}

/// Least squares, then again without what lies beyond the gate around the median distance of the first line.
void ClockModel::fit() {
  const std::size_t n = std::min(count_, kMost);
  std::array<double, kMost> distance_ns{};
  double gate_ns = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 3; ++round) {
    double used = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0, sum_rr = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double x = frame_ns_ * static_cast<double>(stamps_[i].number - origin_.number);
      const double y = static_cast<double>(stamps_[i].t_ns - origin_.t_ns);
      const double r = y - (offset_ns_ + rate_ * x);
      if (round > 0 && std::abs(r) > gate_ns) continue;
      used += 1;
      sum_x += x;
      sum_y += y;
      sum_xx += x * x;
      sum_xy += x * y;
      sum_rr += r * r;
    }
    const double spread = used * sum_xx - sum_x * sum_x;
    if (used < kLeast / 2.0 || !(spread > 0)) return;
    rate_ = (used * sum_xy - sum_x * sum_y) / spread;
    offset_ns_ = (sum_y - rate_ * sum_x) / used;
    if (round > 0) jitter_ns_ = std::sqrt(sum_rr / used);
    for (std::size_t i = 0; i < n; ++i)
      distance_ns[i] = std::abs(static_cast<double>(stamps_[i].t_ns - origin_.t_ns) - line_ns(stamps_[i].number));
    gate_ns = std::max(kGate * 1.4826 * median(std::span(distance_ns).first(n)),
                       kGate * kLeastJitter_ns);  // of a normal distribution
  }
}

}  // namespace duo
