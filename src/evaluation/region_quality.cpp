#include <fmt/format.h>

#include "duoptic/depth_quality.h"

namespace duo {
namespace {

constexpr int kRegionFrames = 40;  // as duoptic quality takes
constexpr int kFiguresEvery = 5;   // frames, of which the figures are worked out anew: that of the noise takes milliseconds

}  // namespace

std::vector<std::string> lines_of(const DepthQuality& q) {
  std::vector<std::string> lines = {fmt::format("{:.3f} m away, turned by {:.1f} degrees", q.distance_m, q.angle_deg),
                                    fmt::format("fill rate {:.1f} %", q.fill_rate_percent),
                                    fmt::format("plane-fit RMS {:.2f} mm, {:.3f} px", q.plane_fit_rms_mm, q.subpixel_rms_px)};
  if (q.frames > 1)
    lines.push_back(fmt::format("temporal noise {:.2f} mm, {:.2f} %, of {} frames", q.temporal_noise_mm,
                                q.temporal_noise_percent, q.frames));
  if (q.z_error_mm) lines.push_back(fmt::format("z error {:+.1f} mm, {:+.2f} %", *q.z_error_mm, *q.z_accuracy_percent));
  return lines;
}

void RegionQuality::set_distance(double distance_m) {
  if (distance_m == distance_m_) return;
  distance_m_ = distance_m;
  start();
}

void RegionQuality::choose(const Rectified& rectified, Window region) {
  rectified_ = rectified;
  region_ = region.within(rectified.size);
  lines_.clear();
  start();
}

void RegionQuality::start() {
  meter_.reset();
  last_.reset();
  frames_ = 0;
  if (region_.empty()) return;
  meter_.emplace(rectified_, region_, distance_m_ > 0 ? std::optional(distance_m_) : std::nullopt);
}

void RegionQuality::add(const Frame& frame) {
  if (!meter_ || last_ == frame.sequence) return;
  if (frames_ == kRegionFrames) start();
  last_ = frame.sequence;
  if (const auto added = meter_->add(frame); !added) {
    lines_ = {added.error().what};
    return;
  }
  if (frames_++ % kFiguresEvery != 0) return;
  lines_ = lines_of(meter_->quality());
}

}  // namespace duo
