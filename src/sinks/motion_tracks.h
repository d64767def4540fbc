// Persons through a run as animation programs have them: a pose per frame, of bones with fixed lengths. Kept in memory until a
// file of them is written, some 30 bytes per person, joint and frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "body/bone_turns.h"
#include "duoptic/sink.h"

namespace duo {

/// What animation programs call the bone that begins at a joint: "LeftForeArm", "LeftHandIndex1".
std::string bone_name(JointId joint);

/// Places of frames in a file that has one each frame_s, from the first frame on: a live source may have left frames out.
class FrameSlots {
 public:
  explicit FrameSlots(double frame_s) : frame_s_(frame_s) {}
  std::size_t slot_at(double t_s);
  std::size_t count() const { return count_; }
  double frame_s() const { return frame_s_; }

 private:
  double frame_s_, start_s_ = 0;
  std::size_t count_ = 0;
};

/// One person through all frames.
class MotionTrack {
 public:
  /// `name_end`: what makes the names of its joints its own.
  MotionTrack(const Skeleton& skeleton, std::string name_end);

  /// Frame `slot`; those that were left out hold the one before, as those do in which a joint is lost.
  void add(std::size_t slot, const Person& person);
  const Skeleton& skeleton() const { return skeleton_; }
  std::string joint_name(std::size_t joint) const;
  /// The joints that hang from a joint.
  const std::vector<std::size_t>& children(std::size_t joint) const { return children_[joint]; }

  /// From the parent's joint at rest, a T-pose with the person's left at +x: as long as the median of all frames that
  /// show both ends of the bone.
  ///
  /// Units  metres
  Vec3 offset_m(std::size_t joint) const;

  /// Units  metres, y up; turns of each joint in its parent's axes
  struct Pose {
    Vec3 root_m;
    std::vector<Mat3> turns;
  };
  /// One per slot. Before the person was known first it is where it was then; never known, it is at rest.
  std::vector<Pose> poses(std::size_t count) const;

 private:
  double length_m(std::size_t joint) const;

  const Skeleton& skeleton_;
  std::string name_end_;
  std::vector<std::vector<std::size_t>> children_;
  std::vector<std::vector<Vec3>> frames_;                 // places of the joints, y up; empty while one of them is lost
  std::vector<std::vector<double>> known_m_, hanging_m_;  // by joint: lengths of the bone that ends there, found and made up
};

/// All persons of a run.
class MotionTracks {
 public:
  explicit MotionTracks(const TrackHeader& header) : skeletons_(header.skeletons), slots_(header.frame_s) {}
  void add(const TrackedFrame& frame);
  /// In the order in which they came; where nobody came, one at rest, because files need a root.
  const std::vector<MotionTrack>& finished();
  std::size_t count() const { return slots_.count(); }
  double frame_s() const { return slots_.frame_s(); }

 private:
  MotionTrack& track_of(const Person& person);

  std::vector<const Skeleton*> skeletons_;
  FrameSlots slots_;
  std::vector<std::uint32_t> ids_;  // of tracks_
  std::vector<MotionTrack> tracks_;
};

}  // namespace duo
