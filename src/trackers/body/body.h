// One person, from frame to frame.
#pragma once

#include <optional>
#include <span>

#include "duoptic/person.h"
#include "duoptic/window.h"
#include "trackers/body/fit.h"
#include "trackers/body/frame_view.h"
#include "trackers/body/seen_trunk.h"
#include "trackers/body/sides.h"

namespace duo::body {

/// Follows one person: predict, detect, lift, choose, fit, learn.
class Body {
 public:
  /// None where the frame shows no depth on the trunk, or a trunk that no person has.
  static std::optional<Body> start(const FrameView& frame, const SeenBody& seen);

  /// The next frame comes `times` as long after the last one as that one came after the one before.
  void stretch_step(double times);
  /// Where the trunk's middle is expected in the next frame, and its depth.
  Vec3 expected_trunk() const;
  /// Where to look for the body in the next frame after one that did not show it.
  TurnedSquare expected_region(const FrameView& frame) const;
  /// Around the body in the picture, as expected in the next frame, and a hand's breadth more.
  Window expected_box(const FrameView& frame) const;
  /// How unlike a seen body is: 0 the same, 1 hardly the same.
  double unlike(const FrameView& frame, const SeenBody& seen) const;
  /// Asks the detector for hands: where to look, this frame. None when the hand would be too small or is out of the picture.
  std::optional<TurnedSquare> hand_region(const FrameView& frame, const SeenBody& seen, bool left) const;

  struct Hands {
    std::array<const SeenHand*, 2> seen = {};  // left, right; null: not asked
  };
  /// `nearer`: people before this one, who were tracked in this frame.
  void track(const FrameView& frame, const SeenBody& seen, const Hands& hands, std::span<const Places* const> nearer = {});
  /// A frame in which nothing was seen of the person, perhaps because somebody covers it.
  void miss(const FrameView& frame, bool covered);

  const Places& places() const { return fitted_.places; }
  const Lengths& lengths() const { return lengths_; }
  /// Ticks since anything was seen of the person.
  double missed() const { return missed_; }
  /// Of the joints that the last frame could show, the share that it did: marked in the picture, where depth was looked for and
  /// neither somebody nor something stands before them. None where it could show none, where the person was not looked at, or
  /// where depth was looked for, nobody being before, at less than half of the marked ones.
  std::optional<double> seen_share() const { return seen_share_; }
  /// Whether the trunk did not stand out of what is beside it when it was tracked last, as a picture on a wall does not.
  bool is_flat() const { return is_flat_; }
  /// Depth of the trunk's skin.
  double trunk_z_m() const { return trunk_z_m_; }
  /// The person's own left or right hand as its network saw it in the last frame, where the body has it, else null. The network
  /// of bodies may have exchanged the hands that track() was given. Valid as long as these.
  const SeenHand* shown_hand(bool left) const {
    const bool shown =
        sight_[left ? 0 : 1] == HandSight::kSeen && states_[left ? JointId::kLeftHand : JointId::kRightHand].seen;
    return shown ? own_hands_[left ? 0 : 1] : nullptr;
  }
  /// Fills the joints of kBody, with which the skeleton of `person` begins, but for their pixels.
  void publish(const FrameView& frame, Person& person) const;

 private:
  struct State {
    Vec3 step;          // since the last frame, smoothed
    double hidden = 0;  // ticks since it was seen
    double astray = 0;  // the same, but bounded while it lies on the back
    double shown = -1;  // ticks from the first frame that showed it to the last one; less than 0: hidden
    bool seen = false, sure = false;
    bool hidden_by_limb = false;  // its forearm or thigh points along the view: what is on a surface is not the joint
    bool absent = false;          // its network saw no hand
  };

  explicit Body(double scale) : lengths_(scale) {}
  void predict(Scene& scene, double ticks) const;
  void learn_pace(double ticks);
  void detect(const FrameView& frame, const SeenBody& seen, const Hands& hands, Scene& scene);
  void detect_hand(const FrameView& frame, const SeenHand* hand, bool left, Scene& scene);
  void lift(Scene& scene) const;
  void update(const FrameView& frame, const Scene& scene, const Choices& chosen);
  void learn(const FrameView& frame, const Scene& scene);

  Lengths lengths_;
  HipMark hip_mark_;
  SurfaceMap map_;
  Fitted fitted_;
  PerJoint<State> states_;
  LimbSamples samples_;
  Fit fit_;
  std::array<HandShift, 2> hand_shift_ = {};  // left, right
  std::array<HandSight, 2> sight_ = {};
  std::array<const SeenHand*, 2> own_hands_ = {};  // of the last frame
  TurnedSquare region_;                            // where the body was looked for last
  Vec2 region_from_px_;                            // where its trunk was then
  TrunkColor color_;
  double trunk_z_m_ = 0;
  Vec3 pace_;  // of the trunk's middle from frame to frame, as it walks
  std::optional<double> seen_share_;
  double missed_ = 0;  // ticks
  int age_ = 0;
  bool is_flat_ = false;
  Sides sides_;
  LegSides leg_sides_;
};

}  // namespace duo::body
