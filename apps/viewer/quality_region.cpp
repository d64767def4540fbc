#include "quality_region.h"

#include <fmt/format.h>

namespace duo::app::view {
namespace {

constexpr int kFrames = 40;  // as duoptic quality takes
constexpr int kEvery = 5;    // frames, of which the figures are worked out anew: that of the noise takes milliseconds

}  // namespace

void QualityRegion::set_distance(double distance_m) {
  if (distance_m == distance_m_) return;
  distance_m_ = distance_m;
  start();
}

void QualityRegion::choose(const Rectified& rectified, duo::Window region) {
  rectified_ = rectified;
  region_ = region.within(rectified.size);
  lines_.clear();
  start();
}

void QualityRegion::start() {
  meter_.reset();
  last_.reset();
  frames_ = 0;
  if (region_.empty()) return;
  meter_.emplace(rectified_, region_, distance_m_ > 0 ? std::optional(distance_m_) : std::nullopt);
}

void QualityRegion::add(const Frame& frame) {
  if (!meter_ || last_ == frame.sequence) return;
  if (frames_ == kFrames) start();
  last_ = frame.sequence;
  if (const auto added = meter_->add(frame); !added) {
    lines_ = {added.error().what};
    return;
  }
  if (frames_++ % kEvery != 0) return;
  const DepthQuality q = meter_->quality();
  lines_ = {fmt::format("{:.3f} m away, turned by {:.1f} degrees", q.distance_m, q.angle_deg),
            fmt::format("fill rate {:.1f} %", q.fill_rate_percent),
            fmt::format("plane-fit RMS {:.2f} mm, {:.3f} px", q.plane_fit_rms_mm, q.subpixel_rms_px)};
  if (q.frames > 1)
    lines_.push_back(fmt::format("temporal noise {:.2f} mm, {:.2f} %, of {} frames", q.temporal_noise_mm,
                                 q.temporal_noise_percent, q.frames));
  if (q.z_error_mm) lines_.push_back(fmt::format("z error {:+.1f} mm, {:+.2f} %", *q.z_error_mm, *q.z_accuracy_percent));
}

}  // namespace duo::app::view
