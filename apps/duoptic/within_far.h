// Depth that a limit leaves.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "duoptic/sink.h"
#include "duoptic/statistics.h"

namespace duo::app {

/// Whether --far leaves anything.
class WithinFar {
 public:
  explicit WithinFar(double far_m) : far_m_(far_m) {}
  void see(const Image<std::uint16_t>& depth_mm) {
    if (far_m_ == kNoFarLimit_m) return;
    std::vector<double> known_m;
    for (int y = 0; y < depth_mm.height(); ++y)
      for (int x = 0; x < depth_mm.width(); ++x)
        if (depth_mm.at(y, x) > 0) known_m.push_back(1e-3 * depth_mm.at(y, x));
    known_ += static_cast<double>(known_m.size());
    within_ += static_cast<double>(std::count_if(known_m.begin(), known_m.end(), [&](double z_m) { return z_m <= far_m_; }));
    if (!known_m.empty()) nearest_m_ = std::min(nearest_m_, quantile(std::move(known_m), 0.01));
  }
  std::string warning() const {
    constexpr double kAlmostNone = 0.01;
    if (within_ >= kAlmostNone * known_ || known_ == 0) return {};
    return fmt::format("almost all that was found lies farther than --far {:g} and is left out: the nearest is {:.2f} m away",
                       far_m_, nearest_m_);
  }

 private:
  const double far_m_;
  double known_ = 0, within_ = 0, nearest_m_ = kNoFarLimit_m;
};

}  // namespace duo::app
