// What the thesis tracker observes in a frame on a device: colours and points of all joints in one recording.
#pragma once

#include "stages/erode/erode_vk.h"
#include "stages/hsv/hsv_vk.h"
#include "stages/mark_targets/mark_targets_vk.h"
#include "stages/match_points/match_points_vk.h"
#include "stages/region/region_vk.h"
#include "stages/sift/sift_vk.h"
#include "stages/sums/sums_vk.h"
#include "stages/types/sift_list.h"
#include "trackers/thesis/observation.h"
#include "trackers/thesis/place_joints_vk.h"

namespace duo::vk {

/// Kernels, and memory for one frame at a time.
///
/// Exact    as thesis::MapObserver, but for SIFT; see vk::Sift
/// Threads  one
class ObserveJoints {
 public:
  struct Maps {
    BufferView<Rgb8> color;
    BufferView<std::uint8_t> left;
    BufferView<std::uint16_t> d_q4;
  };
  /// Errors  the device lacks memory, or the driver refuses a kernel
  static Result<ObserveJoints> make(Device& device, Size size);

  /// Each run of the recording observes what was expected last.
  void record(Recorder& recorder, const Maps& maps) const;
  /// Once after each expect() that gave true, before record().
  void record_points(Recorder& recorder) const;
  /// True if there are other points than before.
  bool expect(const Expectation& expected);
  /// What the recording that ran last saw.
  void read(Observation& seen) const;

 private:
  Result<void> make_kernels(Device& device);
  Result<void> make_memory(Device& device);

  Size size_;
  Hsv hsv_;
  MarkTargets mark_targets_;
  Erode erode_;
  Region region_;
  Sums sums_;
  Sift sift_;
  MatchPoints match_points_;
  PlaceJoints place_joints_;
  Region::Scratch forest_;
  Sums::Scratch partial_;
  Sift::Scratch space_;
  Buffer targets_, tasks_, areas_, windows_, places_;  // written by the CPU for each frame
  Buffer points_up_, ways_up_, points_, ways_;         // the stored points, and the way from each to its joint
  Buffer hue_, saturation_, value_, marks_, eroded_;
  Buffer labels_, colors_, seen_, matches_, joints_, colors_down_, joints_down_;
  std::shared_ptr<const std::vector<JointPoints>> stored_;
};

}  // namespace duo::vk
