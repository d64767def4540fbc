// One arm: predict where its joints are, observe them in the frame, update.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "duoptic/result.h"
#include "duoptic/tracker.h"
#include "trackers/arm/bones.h"
#include "trackers/arm/hand.h"
#include "trackers/raw_left.h"
#include "trackers/arm/torso.h"

namespace duo::arm {

/// One frame as the arm sees it.
struct Scene {
  const Grid& grid;
  const GrayLevels& gray;
  double skew_s = 0;  // how much later the right picture was taken
};

struct TrackedJoint {
  Vec3 p;
  Vec3 step;  // its way since the last frame, metres
  double sigma_m = 0.02, confidence = 1;
  JointState state = JointState::kSeen;
  int unseen = 0;  // frames since it was measured
  bool seen() const { return unseen == 0; }
};

/// The joint behind a shoulder's cloth at a place of the grid; none where too little of it has depth.
std::optional<Vec3> shoulder_at(const Grid& grid, Vec2 at, double depth_m, std::vector<double>& scratch);

class Arm {
 public:
  Arm(const Grid& grid, double frame_s);

  /// Learns the arm from clicks on the rectified picture, in full pixels.
  ///
  /// `arm` names the joints in messages.
  ///
  /// Errors  no depth near a click, clicks that span no arm, no surface around the hand
  Result<void> start(const Scene& scene, const Skeleton& arm, std::span<const Vec2, kParts> clicks_px);
  /// `rivals`: hands of other tracked arms.
  void track(const Scene& scene, std::span<const Vec3> rivals);

  const TrackedJoint& joint(Part which) const;

 private:
  struct Prediction {
    Vec3 hand, elbow;
  };
  struct Candidate {
    HandSeen hand;
    ElbowSeen elbow;
    double score = 0;
  };
  struct Observation {
    std::optional<Candidate> arm;  // hand and elbow together
    ElbowSeen elbow;               // with the hand, or alone
  };

  // The method, frame by frame (arm.cpp).
  Prediction predict() const;
  Observation observe(const Scene& scene, const Prediction& predicted, std::span<const Vec3> rivals);
  void update(const Scene& scene, const Prediction& predicted, const Observation& seen);

  void update_shoulder(const Grid& grid);
  void update_hand(const Scene& scene, const Prediction& predicted, const std::optional<Candidate>& seen);
  void update_elbow(const Scene& scene, const Prediction& predicted, const Observation& seen);
  void follow_hand_outside(const Grid& grid);
  double skew_sigma_m(const Scene& scene, const TrackedJoint& joint) const;

  // Candidates for the hand (arm_candidates.cpp).
  std::optional<Candidate> best_candidate(const Scene& scene, const Prediction& predicted);
  std::optional<Candidate> candidate(const Grid& grid, const Region& region, const Prediction& predicted, bool gated,
                                     bool by_skin);
  std::span<const Region> find_limb(const Grid& grid, const Prediction& predicted);
  double least_score(const Candidate& best) const;

  // The first frame (arm_start.cpp).
  std::vector<std::uint8_t> find_person(const Grid& grid);
  Result<void> learn_first(const Scene& scene, const std::vector<std::uint8_t>& person);
  void learn_others(const Grid& grid, const std::vector<std::uint8_t>& person);
  void learn_hand_length(const Grid& grid);

  // What is learnt while it is seen (arm_learn.cpp).
  void learn(const Scene& scene, const std::optional<Candidate>& seen);
  void learn_shoulder(const Grid& grid);
  void learn_body(const Grid& grid);
  void learn_colors(const Grid& grid, bool arm_seen);
  void follow_others(const Grid& grid);
  void renew_patches(const Scene& scene);

  void find_silhouette(const Grid& grid, std::span<const Vec3> rivals);
  Chain chain() const { return {hand_.p, elbow_.p, shoulder_.p}; }
  double seconds(int frames) const { return frames * frame_s_; }

  static constexpr std::size_t kMostOwnOthers = 12;
  static constexpr double kLearnShoulderS = 1;

  Params params_;
  double frame_s_;
  Lengths lengths_;
  double hand_centre_m_ = 0;                       // from the fingertips
  Vec3 first_upper_;                               // direction of the upper arm at the start, in the torso frame
  Vec3 first_elbow_, first_shoulder_, first_ray_;  // at the start; the ray has z = 1
  double shoulder_behind_m_ = 0;                   // the joint, behind where the click read it
  std::vector<double> shoulder_misses_m_;          // what each frame says of that
  TrackedJoint hand_, elbow_, shoulder_;
  int frame_ = 0;

  Torso torso_;
  Background background_;
  ColorTable colors_;
  BodyMap body_skin_, body_;
  std::vector<OtherSkin> others_;
  std::size_t own_others_ = 0;  // those found at the start; rivals come after them
  Silhouette silhouette_;

  Regions skin_regions_, limb_regions_, other_regions_;
  HandFinder hands_;
  std::vector<std::uint8_t> mask_, scratch_;
  std::vector<double> depths_m_;
};

}  // namespace duo::arm
