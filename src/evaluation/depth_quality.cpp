#include "duoptic/depth_quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <vector>

#include "core/check.h"
#include "duoptic/statistics.h"

namespace duo {
namespace {

constexpr std::size_t kFewestPoints = 100, kOutlierShare = 200;  // one in 200 on each side
constexpr double kNoDepth = 0;

/// normal . p = distance_m, with the normal away from the camera.
struct FittedPlane {
  Vec3 normal;
  double distance_m = 0;
};

/// The plane with the least sum of squared distances to the points; none when they lie on a line.
std::optional<FittedPlane> fit_plane(const std::vector<Vec3>& points_m) {
  Vec3 middle;
  for (const Vec3& p : points_m) middle = middle + p;
  middle = (1.0 / static_cast<double>(points_m.size())) * middle;
  cv::Matx33d spread = cv::Matx33d::zeros();
  for (const Vec3& p : points_m) {
    const Vec3 off = p - middle;
    const cv::Vec3d v(off.x, off.y, off.z);
    spread += v * v.t();
  }
  cv::Vec3d sizes;
  cv::Matx33d axes;
  if (!cv::eigen(spread, sizes, axes) || !(sizes[1] > 1e-9 * sizes[0])) return std::nullopt;
  Vec3 normal{axes(2, 0), axes(2, 1), axes(2, 2)};
  if (dot(normal, middle) < 0) normal = -1.0 * normal;
  return FittedPlane{normal, dot(normal, middle)};
}

double root_of_mean(double sum, std::size_t count) { return std::sqrt(sum / static_cast<double>(count)); }

}  // namespace

struct DepthQualityMeter::State {
  struct Figures {  // of each frame
    std::vector<double> fill_percent, distance_m, angle_deg, rms_mm, rms_px;
  };
  Rectified rectified;
  Window region;
  std::optional<double> true_distance_m;
  Figures figures;
  std::vector<std::vector<float>> z_m;  // of each frame, the region row by row; kNoDepth where nothing is known
};

DepthQualityMeter::DepthQualityMeter(const Rectified& rectified, Window region, std::optional<double> true_distance_m)
    : state_(std::make_unique<State>(State{rectified, region.within(rectified.size), true_distance_m, {}, {}})) {}
DepthQualityMeter::DepthQualityMeter(DepthQualityMeter&&) noexcept = default;
DepthQualityMeter::~DepthQualityMeter() = default;

Result<void> DepthQualityMeter::add(const Frame& frame) {
  State& s = *state_;
  const Window& region = s.region;
  std::vector<Vec3> points_m;
  std::vector<float> z_m;
  for (int y = region.y; y < region.y + region.height; ++y)
    for (int x = region.x; x < region.x + region.width; ++x) {
      const std::uint16_t d_q4 = frame.disparity.d_q4.at(y, x);
      const bool known = d_q4 != Disparity::kNone && d_q4 != 0;
      if (known) points_m.push_back(s.rectified.triangulate({static_cast<double>(x), static_cast<double>(y)}, d_q4 / 16.0));
      z_m.push_back(known ? static_cast<float>(points_m.back().z) : static_cast<float>(kNoDepth));
    }
  const auto refused = [&](const std::string& why) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot measure depth in {},{},{},{}: {}", region.x, region.y, region.width, region.height, why)};
  };
  if (points_m.size() < kFewestPoints)
    return refused(
        fmt::format("{} of its {} pixels have a depth; show a wall with texture there", points_m.size(), z_m.size()));
  const auto plane = fit_plane(points_m);
  if (!plane) return refused("its points lie on a line; choose a wider region");

  s.figures.fill_percent.push_back(100.0 * static_cast<double>(points_m.size()) / static_cast<double>(z_m.size()));
  s.figures.distance_m.push_back(plane->distance_m);
  s.figures.angle_deg.push_back(std::acos(std::min(std::abs(plane->normal.z), 1.0)) * 180 / std::numbers::pi);
  std::sort(points_m.begin(), points_m.end(), [](const Vec3& a, const Vec3& b) { return a.z < b.z; });
  const std::size_t outliers = points_m.size() / kOutlierShare, count = points_m.size() - 2 * outliers;
  double squares_m2 = 0, squares_px2 = 0;
  for (std::size_t i = outliers; i < outliers + count; ++i) {
    const double off_m = dot(plane->normal, points_m[i]) - plane->distance_m;
    const double foot_z_m = points_m[i].z - off_m * plane->normal.z;
    const double off_px = s.rectified.disparity_px(points_m[i].z) - s.rectified.disparity_px(foot_z_m);
    squares_m2 += off_m * off_m;
    squares_px2 += off_px * off_px;
  }
  s.figures.rms_mm.push_back(1000 * root_of_mean(squares_m2, count));
  s.figures.rms_px.push_back(root_of_mean(squares_px2, count));
  s.z_m.push_back(std::move(z_m));
  return {};
}

namespace {

struct TemporalNoise {
  double mm = 0, percent = 0;
};

/// Over the pixels that have a depth in at least half of the frames.
TemporalNoise temporal_noise(const std::vector<std::vector<float>>& z_m) {
  std::vector<double> deviations_mm, shares;
  std::vector<double> values;
  for (std::size_t pixel = 0; pixel < z_m[0].size(); ++pixel) {
    values.clear();
    for (const auto& frame : z_m)
      if (frame[pixel] != kNoDepth) values.push_back(frame[pixel]);
    if (values.size() < 2 || 2 * values.size() < z_m.size()) continue;
    double mean = 0, squares = 0;
    for (const double z : values) mean += z / static_cast<double>(values.size());
    for (const double z : values) squares += (z - mean) * (z - mean);
    const double deviation = root_of_mean(squares, values.size() - 1);
    deviations_mm.push_back(1000 * deviation);
    shares.push_back(100 * deviation / median(values));
  }
  if (deviations_mm.empty()) return {};
  return {median(deviations_mm), median(shares)};
}

}  // namespace

DepthQuality DepthQualityMeter::quality() const {
  const State& s = *state_;
  DUO_CHECK(!s.z_m.empty());
  State::Figures f = s.figures;
  const TemporalNoise noise = temporal_noise(s.z_m);
  DepthQuality out{.frames = static_cast<int>(s.z_m.size()),
                   .fill_rate_percent = median(f.fill_percent),
                   .distance_m = median(f.distance_m),
                   .angle_deg = median(f.angle_deg),
                   .plane_fit_rms_mm = median(f.rms_mm),
                   .subpixel_rms_px = median(f.rms_px),
                   .temporal_noise_mm = noise.mm,
                   .temporal_noise_percent = noise.percent,
                   .z_error_mm = {},
                   .z_accuracy_percent = {}};
  if (s.true_distance_m) {
    out.z_error_mm = 1000 * (out.distance_m - *s.true_distance_m);
    out.z_accuracy_percent = 100 * (out.distance_m / *s.true_distance_m - 1);
  }
  return out;
}

Window middle_half(Size size) { return {size.width / 4, size.height / 4, size.width / 2, size.height / 2}; }

}  // namespace duo
