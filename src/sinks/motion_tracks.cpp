#include "sinks/motion_tracks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "duoptic/statistics.h"

namespace duo {

std::string bone_name(JointId joint) {
  constexpr std::array<std::string_view, kBodyJointIds> kBoneNames = {
      "Hips",      "Spine",    "Chest",       "Neck",         "Head",       "LeftArm",   "LeftForeArm",
      "LeftWrist", "LeftHand", "RightArm",    "RightForeArm", "RightWrist", "RightHand", "LeftUpLeg",
      "LeftLeg",   "LeftFoot", "LeftToeBase", "RightUpLeg",   "RightLeg",   "RightFoot", "RightToeBase"};
  constexpr std::array<std::string_view, kFingers> kFingerNames = {"Thumb", "Index", "Middle", "Ring", "Pinky"};
  const auto at = static_cast<std::size_t>(joint);
  if (!is_finger(joint)) return std::string(kBoneNames[at]);
  const auto [finger, in_finger] = finger_of(joint);
  return fmt::format("{}Hand{}{}", joint < JointId::kRightThumbCmc ? "Left" : "Right", kFingerNames[finger], in_finger + 1);
}

std::size_t FrameSlots::slot_at(double t_s) {
  if (count_ == 0) start_s_ = t_s;
  const auto slot = static_cast<std::size_t>(std::max<long long>(std::llround((t_s - start_s_) / frame_s_), 0));
  count_ = std::max(count_, slot + 1);
  return slot;
}

MotionTrack::MotionTrack(const Skeleton& skeleton, std::string name_end)
    : skeleton_(skeleton),
      name_end_(std::move(name_end)),
      children_(skeleton.joints.size()),
      known_m_(skeleton.joints.size()),
      hanging_m_(skeleton.joints.size()) {
  for (std::size_t j = 1; j < children_.size(); ++j)
    children_[static_cast<std::size_t>(skeleton.joints[j].parent)].push_back(j);
}

void MotionTrack::add(std::size_t slot, const Person& person) {
  frames_.resize(std::max(frames_.size(), slot + 1));
  auto places = known_places(person, axes_from_rig(Axes::kOpengl));
  if (!places) return;
  const auto known = [&](std::size_t j) { return person.joints[j].state != JointState::kLost; };
  for (std::size_t j = 1; j < places->size(); ++j) {
    const auto parent = static_cast<std::size_t>(skeleton_.joints[j].parent);
    (known(j) && known(parent) ? known_m_ : hanging_m_)[j].push_back(norm((*places)[j] - (*places)[parent]));
  }
  frames_[slot] = std::move(*places);
}

std::string MotionTrack::joint_name(std::size_t joint) const { return bone_name(skeleton_.joints[joint].id) + name_end_; }

double MotionTrack::length_m(std::size_t joint) const {
  constexpr double kUnseen_m = 0.25;
  const std::vector<double>& of = known_m_[joint].empty() ? hanging_m_[joint] : known_m_[joint];
  return of.empty() ? kUnseen_m : median(std::vector(of));
}

Vec3 MotionTrack::offset_m(std::size_t joint) const {
  return length_m(joint) * rest_direction(skeleton_.joints[joint].id, BodyAxes::kRightHanded);
}

std::vector<MotionTrack::Pose> MotionTrack::poses(std::size_t count) const {
  BoneTurner turner(skeleton_, BodyAxes::kRightHanded);
  std::vector<double> lengths_m(children_.size());
  for (std::size_t j = 1; j < lengths_m.size(); ++j) lengths_m[j] = length_m(j);
  const Pose rest{{}, std::vector<Mat3>(children_.size())};
  std::vector<Pose> out(count, rest);
  std::size_t first_known = count;
  for (std::size_t i = 0; i < count; ++i) {
    const bool known = i < frames_.size() && !frames_[i].empty();
    if (auto turns = known ? turner.turn(frames_[i], lengths_m) : std::nullopt) {
      out[i] = {frames_[i][0], std::move(*turns)};
      first_known = std::min(first_known, i);
    } else if (first_known < i) {
      out[i] = out[i - 1];
    }
  }
  if (first_known < count) std::fill_n(out.begin(), first_known, out[first_known]);
  return out;
}

void MotionTracks::add(const TrackedFrame& frame) {
  const std::size_t slot = slots_.slot_at(frame.t_s);
  for (const Person& person : frame.people)
    if (person.skeleton != nullptr) track_of(person).add(slot, person);
}

const std::vector<MotionTrack>& MotionTracks::finished() {
  if (tracks_.empty() && !skeletons_.empty()) tracks_.emplace_back(*skeletons_[0], "");
  return tracks_;
}

MotionTrack& MotionTracks::track_of(const Person& person) {
  bool same_names = false;
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    if (&tracks_[i].skeleton() != person.skeleton) continue;
    if (ids_[i] == person.id) return tracks_[i];
    same_names = true;
  }
  ids_.push_back(person.id);
  return tracks_.emplace_back(*person.skeleton, same_names ? fmt::format("_{}", person.id) : "");
}

}  // namespace duo
