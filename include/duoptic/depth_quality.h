// How good depth is, measured on a flat wall: fill rate, plane fit, sub-pixel error, temporal noise, distance.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "duoptic/frame.h"
#include "duoptic/result.h"
#include "duoptic/rig.h"
#include "duoptic/window.h"

namespace [[gnu::visibility("default")]] duo {

/// What the frames of a still, flat wall tell of a rig and its matcher. Each figure of a single frame is the median over all
/// frames.
///
/// Source  the definitions of RealSense's Depth Quality Tool: z_i is a pixel's depth, zp_i that of its foot on the plane that
///         least squares fit to all points; the nearest and the farthest 0.5 % of the points are then left out
struct DepthQuality {
  int frames = 0;
  double fill_rate_percent = 0;              // pixels of the region with a depth
  double distance_m = 0;                     // from the left camera's centre to the plane, at a right angle
  double angle_deg = 0;                      // between the optical axis and the plane's normal
  double plane_fit_rms_mm = 0;               // root of the mean of (point to plane)^2
  double subpixel_rms_px = 0;                // root of the mean of (b f / z_i - b f / zp_i)^2
  double temporal_noise_mm = 0;              // median over pixels of the standard deviation of z; 0 of a single frame
  double temporal_noise_percent = 0;         // likewise of the standard deviation divided by the median of z
  std::optional<double> z_error_mm;          // distance_m less the true one
  std::optional<double> z_accuracy_percent;  // likewise divided by the true one
};

/// Takes the frames one by one.
class DepthQualityMeter {
 public:
  /// region  of the rectified left picture, px
  /// true_distance_m  from the left camera's centre to the wall, when it is known
  DepthQualityMeter(const Rectified& rectified, Window region, std::optional<double> true_distance_m = std::nullopt);
  DepthQualityMeter(DepthQualityMeter&&) noexcept;
  ~DepthQualityMeter();

  /// Errors  the region has fewer than 100 pixels with a depth, or these lie on a line
  Result<void> add(const Frame& frame);
  /// Of the frames so far; at least one.
  DepthQuality quality() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The figures as lines of text: distance, fill rate, plane fit; noise of several frames; error where the distance is known.
std::vector<std::string> lines_of(const DepthQuality& quality);

/// The figures of a region that is chosen anew now and then, while frames come.
class RegionQuality {
 public:
  /// The wall is at this distance from the left lens; 0: not known.
  void set_distance(double distance_m);
  /// px of the depth picture; an empty region takes it away.
  void choose(const Rectified& rectified, Window region);
  const Window& region() const { return region_; }

  /// The last 40 frames count, at most; one that was added before is passed over.
  void add(const Frame& frame);
  /// Lines of text: figures, or why there are none.
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  void start();

  Rectified rectified_;
  Window region_;
  double distance_m_ = 0;
  std::optional<DepthQualityMeter> meter_;
  int frames_ = 0;
  std::optional<std::uint64_t> last_;
  std::vector<std::string> lines_;
};

/// The half of the picture around its middle.
Window middle_half(Size size);

}  // namespace duo
