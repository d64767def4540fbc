#include <cmath>
#include <vector>

#include "core/lens.h"
#include "duoptic/evaluation.h"
#include "duoptic/statistics.h"

namespace duo {
namespace {

/// Counts pixels that should have a disparity, that have one, and how far off these are.
class Tally {
 public:
  void missing() { ++pixels_; }
  void found(double error_px, double depth_error) {
    ++pixels_;
    bad_ += error_px > 1.0;
    depth_errors_.push_back(depth_error);
  }
  RenderedAccuracy accuracy() {
    const double found = static_cast<double>(depth_errors_.size());
    if (found == 0) return {};
    return {100 * static_cast<double>(bad_) / found, 100 * found / static_cast<double>(pixels_), 100 * median(depth_errors_)};
  }

 private:
  std::int64_t pixels_ = 0, bad_ = 0;
  std::vector<double> depth_errors_;
};

double disparity_px(std::uint16_t d_q4) { return d_q4 / 16.0; }

}  // namespace

RenderedAccuracy ideal_accuracy(const Frame& frame, const SyntheticPair& ideal) {
  Tally tally;
  for (int y = 0; y < ideal.disparity_px.height(); ++y)
    for (int x = 0; x < ideal.disparity_px.width(); ++x) {
      if (ideal.seen_by_both.at(y, x) == 0) continue;
      const std::uint16_t d_q4 = frame.disparity.d_q4.at(y, x);
      if (d_q4 == Disparity::kNone) {
        tally.missing();
        continue;
      }
      const double d = disparity_px(d_q4), truth = ideal.disparity_px.at(y, x);
      tally.found(std::abs(d - truth), d > 0 ? std::abs(truth / d - 1) : 1);
    }
  return tally.accuracy();
}

RenderedAccuracy raw_accuracy(const Frame& frame, const Rectified& rectified, const SyntheticPair& raw) {
  Tally tally;
  const Mat3 left_from_rig = transposed(rectified.rig_from_left);
  const Lens lens(raw.rig.left);
  for (int y = 0; y < rectified.size.height; ++y)
    for (int x = 0; x < rectified.size.width; ++x) {
      if (frame.left_inside.at(y, x) == 0) continue;
      const std::uint16_t d_q4 = frame.disparity.d_q4.at(y, x);
      if (d_q4 == Disparity::kNone || d_q4 == 0) {
        tally.missing();
        continue;
      }
      const double z = rectified.depth_m(disparity_px(d_q4));
      const Vec3 p_in_left_m = left_from_rig * rectified.unproject({double(x), double(y)}, z);
      const auto at = lens.pixel_of(p_in_left_m);
      if (!at) continue;
      const long column = std::lround(at->x), row = std::lround(at->y);
      if (column < 0 || row < 0 || column >= raw.depth_left_m.width() || row >= raw.depth_left_m.height()) continue;
      const double truth_m = raw.depth_left_m.at(static_cast<int>(row), static_cast<int>(column));
      if (!(truth_m > 0)) continue;
      // Along one ray the depths in both frames keep their ratio.
      const double ratio = p_in_left_m.z / truth_m;
      tally.found(disparity_px(d_q4) * std::abs(ratio - 1), std::abs(ratio - 1));
    }
  return tally.accuracy();
}

}  // namespace duo
