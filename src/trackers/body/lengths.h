// How long a person's bones are: learnt from what is seen, both sides alike.
#pragma once

#include <array>
#include <cstdint>

#include "trackers/body/joints.h"

namespace duo::body {

enum class Bone : std::uint8_t {
  kShoulders,
  kHips,
  kTrunk,
  kUpperArm,
  kForearm,
  kPalm,
  kThigh,
  kShin,
  kFoot,
  kNeckHead,
  kHead
};
inline constexpr std::size_t kBones = 11;

/// Lengths of one person.
///
/// Units  metres; trunk: between the middles of shoulders and hips; palm: from the wrist to its centre; neck_head: from the
///        shoulders' middle to the head; head: from the neck to the same
class Lengths {
 public:
  Lengths();
  /// Of an adult of another size.
  explicit Lengths(double scale);

  double operator[](Bone bone) const { return length_m_[static_cast<std::size_t>(bone)]; }
  /// The same, but kept once samples of a total weight of 50 were learnt, until it turns out to be wrong by more than 8 mm:
  /// bones that are published keep their lengths. At 30 frames per second that takes limbs, of which both sides count, 0.8 s
  /// or more, and shoulders, hips, trunk and head 1.7 s or more.
  double kept(Bone bone) const { return kept_m_[static_cast<std::size_t>(bone)]; }
  /// How well it is known: one standard deviation.
  double sigma_m(Bone bone) const;
  /// One measurement with a weight of 0 .. 1.
  void learn(Bone bone, double measured_m, double weight);
  /// What was measured so far was too short by that much.
  void lengthen(Bone bone, double by_m);

 private:
  static constexpr std::size_t kMostSamples = 256;
  struct Samples {
    std::array<float, kMostSamples> length_m = {}, weight = {};
    std::size_t count = 0, next = 0;
    double total = 0;
  };
  std::array<double, kBones> prior_m_, length_m_, kept_m_;
  std::array<Samples, kBones> samples_ = {};
};

/// How much lower along the trunk a person's hips are marked than others' are. The network sees clothes, of one person 4 cm
/// lower than of another, and hips that are marked low make the trunk longer and the thighs shorter: their ratio tells.
///
/// Units  metres, above 0: too low
class HipMark {
 public:
  double low_m() const;
  /// Lengths between marks that were moved up by `moved_m`, the thigh in line with the trunk.
  void learn(double trunk_m, double thigh_m, double moved_m);

 private:
  double sum_m_ = 0, total_ = 0;
};

}  // namespace duo::body
