#include "duoptic/evaluation.h"

#include <algorithm>
#include <cmath>

#include "duoptic/statistics.h"

namespace duo {
namespace {

std::optional<double> percent(std::int64_t part, std::int64_t whole) {
  if (whole == 0) return {};
  return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

bool is_good(const JointSample& s) { return s.state != JointState::kLost && s.error_mm <= kBadJoint_mm; }

void score_recovery(const std::vector<JointSample>& samples, JointScore& score) {
  int hidden = 0, waited = 0;
  bool waiting = false;
  const auto note = [&] { score.frames_to_recover = std::max(score.frames_to_recover.value_or(0), waited); };
  for (const JointSample& s : samples) {
    if (!s.visible) {
      ++hidden;
      continue;
    }
    if (hidden >= kHiddenFrames && !waiting) {
      waiting = true;
      waited = 0;
    }
    hidden = 0;
    if (!waiting) continue;
    if (is_good(s)) {
      note();
      waiting = false;
    } else {
      ++waited;
    }
  }
  if (waiting) {
    note();
    score.recovered = false;
  }
}

std::optional<double> percentile(std::vector<double> values, double share) {
  return values.empty() ? std::nullopt : std::optional(quantile(values, share));
}

}  // namespace

JointScore score_joint(const std::vector<JointSample>& samples) {
  std::vector<double> visible_mm, hidden_mm;
  std::int64_t visible = 0, bad = 0, hidden = 0, hidden_lost = 0, hidden_false = 0, hidden_inside = 0, known = 0, inside = 0;
  for (const JointSample& s : samples) {
    const bool lost = s.state == JointState::kLost;
    (s.visible ? visible : hidden) += 1;
    if (s.visible) bad += !is_good(s);
    hidden_inside += !s.visible && s.in_picture;
    hidden_lost += !s.visible && s.in_picture && lost;
    if (!s.visible) hidden_false += s.state == JointState::kSeen && s.error_mm > kBadJoint_mm;
    if (lost) continue;
    if (s.visible) visible_mm.push_back(s.error_mm);
    if (!s.visible && s.in_picture) hidden_mm.push_back(s.error_mm);
    ++known;
    inside += s.error_mm <= 3 * s.sigma_mm;
  }
  JointScore score;
  score.median_mm = percentile(visible_mm, 0.5);
  score.p95_mm = percentile(visible_mm, 0.95);
  score.bad_percent = percent(bad, visible);
  score.hidden_median_mm = percentile(hidden_mm, 0.5);
  score.hidden_lost_percent = percent(hidden_lost, hidden_inside);
  score.hidden_false_percent = percent(hidden_false, hidden);
  score.inside_3_sigma_percent = percent(inside, known);
  score_recovery(samples, score);
  return score;
}

void DepthTally::add(const Frame& frame, const Rectified& rectified, const Camera& left, const DepthTruth& truth) {
  if (truth.z_tenth_mm.empty()) return;
  const Mat3 left_from_rig = transposed(rectified.rig_from_left);
  for (int y = 0; y < rectified.size.height; ++y)
    for (int x = 0; x < rectified.size.width; ++x) {
      if (!frame.left_inside.empty() && frame.left_inside.at(y, x) == 0) continue;
      const Vec3 ray_in_rig = rectified.unproject({double(x), double(y)}, 1);
      const Vec3 ray_in_left = left_from_rig * ray_in_rig;
      const long column = std::lround(left.fx_px * ray_in_left.x / ray_in_left.z + left.cx_px);
      const long row = std::lround(left.fy_px * ray_in_left.y / ray_in_left.z + left.cy_px);
      if (column < 0 || row < 0 || column >= truth.figure.width() || row >= truth.figure.height()) continue;
      const int tenth_mm = truth.z_tenth_mm.at(static_cast<int>(row), static_cast<int>(column));
      if (tenth_mm == 0) continue;
      const bool person = truth.figure.at(static_cast<int>(row), static_cast<int>(column)) != 0;
      const double z_in_rig_m = tenth_mm * 1e-4 / ray_in_left.z;  // the ray has z = 1 in the rig frame
      const double true_px = rectified.disparity_px(z_in_rig_m);
      if (x < true_px) continue;  // beyond the right picture's border
      pixels_ += person;
      const std::uint16_t d_q4 = frame.disparity.d_q4.at(y, x);
      if (d_q4 == Disparity::kNone) continue;
      const double d_px = d_q4 / 16.0, error_px = std::abs(d_px - true_px);
      (person ? signed_px_ : background_signed_px_).push_back(d_px - true_px);
      if (!person) continue;
      bad_ += error_px > 1;
      errors_px_.push_back(error_px);
      depth_errors_.push_back(d_px > 0 ? std::abs(true_px / d_px - 1) : 1);
    }
}

std::optional<DepthScore> DepthTally::score() const {
  if (errors_px_.empty()) return {};
  const auto known = static_cast<std::int64_t>(errors_px_.size());
  return DepthScore{*percent(known, pixels_),     *percent(bad_, known),
                    *percentile(errors_px_, 0.5), 100 * *percentile(depth_errors_, 0.5),
                    *percentile(signed_px_, 0.5), percentile(background_signed_px_, 0.5).value_or(0)};
}

}  // namespace duo
