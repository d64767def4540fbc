// When pictures were taken, from stamps that jitter.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "duoptic/frame.h"

namespace duo {

/// A camera takes pictures at a steady rate; its time stamps jitter. The model is a line, time of capture = offset + rate *
/// (number * nominal frame time), fitted to the stamps of the last eight seconds without outliers. With n stamps of standard
/// deviation s the line is off by 2 s / sqrt(n) at its end.
///
/// When a camera changes its rate, or drops pictures without counting them, stamps stay on one side of the line: then the fit
/// starts again.
class ClockModel {
 public:
  explicit ClockModel(double frame_s) : frame_ns_(frame_s * 1e9) {}

  /// The time of capture of picture `number`, which was stamped `stamp_ns`; numbers rise.
  TimeNs capture_ns(std::int64_t number, TimeNs stamp_ns);

  /// The camera's frame time over the nominal one; 1 until a fit is there.
  double rate() const { return rate_; }
  /// Standard deviation of the stamps around the line; 0 until a fit is there.
  double jitter_ns() const { return jitter_ns_; }

 private:
  static constexpr std::size_t kMost = 256, kLeast = 8;
  struct Stamp {
    std::int64_t number;
    TimeNs t_ns;
  };
  void start(const Stamp& stamp);
  bool agrees(const Stamp& stamp);
  void fit();
  double line_ns(std::int64_t number) const;  // after the first stamp's time

  double frame_ns_;
  std::array<Stamp, kMost> stamps_{};
  std::size_t count_ = 0;  // ever added since start()
  Stamp origin_{};
  std::int64_t last_number_ = 0;
  double offset_ns_ = 0, rate_ = 1, jitter_ns_ = 0;
  int off_ = 0;  // stamps in a row on one side far off the line, negative on the early side
  TimeNs given_ns_ = 0;
};

}  // namespace duo
