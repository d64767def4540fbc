// How near tracked joints and depth come to a clip's truth.
#pragma once

#include <optional>
#include <vector>

#include "clip.h"
#include "duoptic/person.h"

namespace duo::app {

/// One joint in one frame: what is true of it, and what the tracker said.
struct JointSample {
  bool visible = false;
  JointState state = JointState::kLost;
  double error_mm = 0;  // means nothing when lost
  double sigma_mm = 0;
};

/// Numbers that a clip gives no occasion for are empty.
struct JointScore {
  std::optional<double> median_mm, p95_mm;       // over visible frames that are not lost
  std::optional<double> bad_percent;             // of visible frames: lost, or off by more than kBad_mm
  std::optional<int> frames_to_recover;          // the most after kHidden or more hidden frames
  bool recovered = true;                         // false: at the end still not, and frames_to_recover only counts up to there
  std::optional<double> hidden_median_mm;        // over hidden frames that are not lost
  std::optional<double> hidden_lost_percent;     // of hidden frames
  std::optional<double> inside_3_sigma_percent;  // of seen and inferred frames, visible or not
};

inline constexpr double kBad_mm = 100;
inline constexpr int kHidden = 5;  // frames in a row

/// Frames to recover: visible frames, from the first after a hiding, before one that is neither lost nor off by more than
/// kBad_mm; 0 when that is the first.
JointScore score_joint(const std::vector<JointSample>& samples);

/// Disparity on the person.
struct DepthScore {
  double coverage_percent = 0;      // of the person's pixels that both cameras reach
  double bad_percent = 0;           // more than 1 px off, of those with a disparity
  double median_px = 0;             // of |d - truth|
  double median_depth_percent = 0;  // of |z - truth| / truth
  double bias_px = 0;               // median of d - truth
  double background_bias_px = 0;    // likewise, on all else that has a disparity; 0 without any
};

/// Collects frames; score() is of all their pixels.
class DepthTally {
 public:
  void add(const Frame& frame, const Rectified& rectified, const Camera& left, const DepthTruth& truth);
  /// Empty without a pixel.
  std::optional<DepthScore> score() const;

 private:
  std::int64_t pixels_ = 0, bad_ = 0;
  std::vector<double> errors_px_, depth_errors_;          // on the person
  std::vector<double> signed_px_, background_signed_px_;  // d - truth
};

/// The value below which `share` of the values lie: of n in order, the one at floor(share (n - 1)).
std::optional<double> percentile(std::vector<double> values, double share);

}  // namespace duo::app
