// How near disparity maps and joints come to the truth: of Middlebury's scenes, of rendered clips, of the rendered room.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "duoptic/frame.h"
#include "duoptic/person.h"
#include "duoptic/pipeline.h"
#include "duoptic/result.h"
#include "duoptic/rig.h"
#include "duoptic/skeleton.h"
#include "duoptic/synthetic.h"

namespace [[gnu::visibility("default")]] duo {

// --- Disparity maps of Middlebury's scenes -------------------------------------------------------------------------------

/// Where the evaluation counts; 255 inside a region, 0 outside.
///
/// Shape   all H x W of the left picture
struct SceneRegions {
  Image<std::uint8_t> all;     // truth known, outside the border that the scene leaves out
  Image<std::uint8_t> nonocc;  // of these, seen by both cameras
  Image<std::uint8_t> disc;    // of these, near a depth discontinuity
};

/// A rectified pair with its true disparity.
struct StereoScene {
  std::string name;
  Pair pair;
  int max_disparity = 0;  // search [0, max_disparity) px
  Image<float> truth_px;  // 0 = unknown
  SceneRegions regions;
};

/// The scene folders that `paths` stand for: a folder with meta.json is a scene, any other folder holds scenes.
///
/// Errors  not a folder; no scene inside
Result<std::vector<std::filesystem::path>> find_scenes(const std::vector<std::filesystem::path>& paths);

/// Reads left.png, right.png, disp_left.png, the official masks where there are any, and meta.json.
///
/// Errors  one of them is missing, is another kind of file, or has another size
Result<StereoScene> load_scene(const std::filesystem::path& folder);

/// The regions of the Middlebury evaluation worked out from the truth alone, for scenes without official masks. Against the
/// official masks of teddy and cones 1 % of nonocc and 6 to 8 % of disc differ.
///
/// Source  after Scharstein and Szeliski, "A taxonomy and evaluation of dense two-frame stereo correspondence algorithms",
///         2002, 5.1: occluded = something nearer lands on the same pixel of the right view; discontinuity = within half a
///         9x9 window of a jump of 2 px or of a pixel that is occluded or unknown
SceneRegions regions_of_truth(const Image<float>& truth_px, int border_px);

inline constexpr std::array<float, 3> kBadThresholds_px = {0.5f, 1.0f, 2.0f};

/// Shares of bad pixels in per cent: [threshold][region], regions nonocc, all, disc.
using BadPercent = std::array<std::array<double, 3>, 3>;

/// Errors of a disparity map as the Middlebury evaluation (version 2) counts them.
struct DisparityScore {
  BadPercent bad_holes;         // a pixel without disparity counts as bad
  BadPercent bad_filled;        // after fill_rows()
  double average_error_px = 0;  // in all, filled
  double coverage_percent = 0;  // of all, before filling
};

/// Disparity in px as float, negative = none.
///
/// Shape   d_px and the scene's truth the same size
DisparityScore score_disparity(View<const float> d_px, const StereoScene& scene);

/// The evaluation's own filling: a hole takes the smaller of the nearest disparities left and right of it on its row.
void fill_rows(View<float> d_px);

/// q4 disparity as float px, negative = none.
Image<float> disparity_as_px(View<const std::uint16_t> d_q4);

/// Pairs made as unlike as two different webcams make them.
struct Perturbation {
  const char* name;
  bool gain = false;   // right picture times 0.8, plus 10
  bool noise = false;  // Gaussian noise of sigma 4 on both
  bool rows = false;   // right picture half a pixel up: the mean of each row and the next
};
/// Each fault alone, then all of them.
std::span<const Perturbation> perturbations();
/// The pair with these faults, always the same ones.
Pair perturb(const Pair& pair, const Perturbation& how);

// --- Frames of the rendered room -----------------------------------------------------------------------------------------

struct RenderedAccuracy {
  double bad_percent = 0;          // more than 1 px off, of the pixels with a disparity
  double coverage_percent = 0;     // pixels with a disparity, of those that both cameras see
  double depth_error_percent = 0;  // median of |z - truth| / truth
};

/// Of the ideal pair: every pixel that both cameras see.
RenderedAccuracy ideal_accuracy(const Frame& frame, const SyntheticPair& ideal);

/// Of the raw pair: each point found is carried back through rectification and lens into the raw left picture and compared
/// with the truth there; coverage is of the pixels that both raw pictures cover.
RenderedAccuracy raw_accuracy(const Frame& frame, const Rectified& rectified, const SyntheticPair& raw);

// --- Persons of rendered clips -------------------------------------------------------------------------------------------

struct JointTruth {
  Vec3 p_in_left_m;           // the joint's centre, in the raw left camera's axes
  double u_px = 0, v_px = 0;  // where it projects in the raw left picture, whether it is seen there or not
  bool in_picture = false;    // in the left one
  bool visible = false;       // in both pictures, nothing in front of it
};
/// Of the joints that a frame's truth has; by JointId.
using FrameTruth = std::array<std::optional<JointTruth>, kJointIds>;

/// Of truth.json: meta.selected_arm ("left" or "right"), meta.skew_ms (0 where there is none), frames[i].joints.NAME.{xyz,
/// uv_left, vis_left, vis_right}; of other people frames[i].others[k].joints. Names that no skeleton has are passed over.
struct ClipTruth {
  std::string name;
  Rig rig;
  Side arm = Side::kRight;  // the arm that moves
  double skew_ms = 0;       // how much later the right pictures were taken
  std::vector<FrameTruth> frames;
  std::vector<std::vector<FrameTruth>> others;  // by other person, then by frame; as many as in every frame

  /// Errors  a frame lacks the joint
  Result<void> check(JointId joint) const;
  /// The first frame in which the cameras see all these joints.
  ///
  /// Errors  there is none
  Result<std::int64_t> first_visible(std::span<const JointId> joints) const;
};

/// Reads calibration_truth.yml and truth.json.
///
/// Errors  one of them is missing or holds something else
Result<ClipTruth> load_clip(const std::filesystem::path& folder);

/// Depth of one frame on the person.
struct DepthTruth {
  Image<std::uint16_t> z_tenth_mm;  // z in 0.1 mm, 0 = none, of a pinhole camera in the left camera's place
  Image<std::uint8_t> figure;       // 255 on the person
};

/// depth/depth_NNNN.png and depth/figure_NNNN.png; empty pictures when this frame has none.
///
/// Errors  they are there and are no such pictures
Result<DepthTruth> load_depth_truth(const std::filesystem::path& folder, std::int64_t frame);
bool has_depth_truth(const std::filesystem::path& folder, std::int64_t frame);

/// One joint in one frame: what is true of it, and what the tracker said.
struct JointSample {
  bool visible = false;
  JointState state = JointState::kLost;
  double error_mm = 0;  // means nothing when lost
  double sigma_mm = 0;
  bool in_picture = true;
};

/// Numbers that a clip gives no occasion for are empty.
struct JointScore {
  std::optional<double> median_mm, p95_mm;       // over visible frames that are not lost
  std::optional<double> bad_percent;             // of visible frames: lost, or off by more than kBadJoint_mm
  std::optional<int> frames_to_recover;          // the most after kHiddenFrames or more hidden frames
  bool recovered = true;                         // false: at the end still not, and frames_to_recover only counts up to there
  std::optional<double> hidden_median_mm;        // over frames in which it is hidden inside the picture and not lost
  std::optional<double> hidden_lost_percent;     // of frames in which it is hidden inside the picture
  std::optional<double> hidden_false_percent;    // of hidden frames: called seen, and off by more than kBadJoint_mm
  std::optional<double> inside_3_sigma_percent;  // of seen and inferred frames, visible or not
};

inline constexpr double kBadJoint_mm = 100;
inline constexpr int kHiddenFrames = 5;  // in a row

/// Frames to recover: visible frames, from the first after a hiding, before one that is neither lost nor off by more than
/// kBadJoint_mm; 0 when that is the first.
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

struct ClipScore {
  std::string clip, tracker;
  std::int64_t first = 0, frames = 0;  // the first that was scored, and how many
  std::int64_t left_out = 0;           // those from the first on of which a camera gave no picture
  double fps = 0;                      // without scoring
  std::vector<std::pair<JointId, JointScore>> joints;
  int people = 1;             // in the truth; the joints are the first one's
  int identity_switches = 0;  // how often the tracked person at a true one's place has another id than the one before
  std::optional<DepthScore> depth;
};

/// What is scored of a clip.
struct ClipEvaluation {
  PipelineSetup pipeline;            // engine, tracker and rig: the true one of the clip, or one found for its cameras
  std::vector<JointId> joints = {};  // none: those of the arm that moves, or all of a tracker that starts by itself
  double jitter_px = 0;              // each click is moved by that
  std::function<Result<void>(Pipeline&)> add_sinks = {};  // called before the first frame; their time is not counted
};

/// A clip through engine and tracker, from the first frame that shows what has to be clicked.
///
/// Errors  those of Pipeline::open(), next() and select(); a joint that the clip or the tracker does not have; videos that end
///         before the truth does
Result<ClipScore> score_clip(const std::filesystem::path& folder, const ClipTruth& truth, ClipEvaluation what);

}  // namespace duo
