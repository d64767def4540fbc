#include <fmt/format.h>

#include "duoptic/frame_files.h"

namespace duo {

void FarWatch::see(const Image<std::uint16_t>& depth_mm) {
  constexpr std::size_t kDepths = 1 << 16;
  if (far_m_ == kNoFarLimit_m) return;
  pixels_.resize(kDepths);
  for (int y = 0; y < depth_mm.height(); ++y)
    for (int x = 0; x < depth_mm.width(); ++x) ++pixels_[depth_mm.at(y, x)];
}

std::string FarWatch::warning() const {
  constexpr double kAlmostNone = 0.01, kNearest = 0.01;  // of the pixels with a depth
  std::int64_t known = 0, within = 0;
  for (std::size_t mm = 1; mm < pixels_.size(); ++mm) {
    known += pixels_[mm];
    if (1e-3 * static_cast<double>(mm) <= far_m_) within += pixels_[mm];
  }
  if (static_cast<double>(within) >= kAlmostNone * static_cast<double>(known)) return {};
  std::size_t nearest_mm = 1;
  for (std::int64_t nearer = pixels_[1]; static_cast<double>(nearer) < kNearest * static_cast<double>(known);)
    nearer += pixels_[++nearest_mm];
  return fmt::format("almost all that was found lies farther than --far {:g} and is left out: the nearest is at {:.2f}", far_m_,
                     1e-3 * static_cast<double>(nearest_mm));
}

}  // namespace duo
