// The semi-global matcher on a device. README.md beside this file tells the method, sgm_ref.cpp the order of its stages.
#pragma once

#include "matchers/sgm/sgm.h"
#include "stages/balance/balance_vk.h"
#include "stages/check_left_right/check_left_right_vk.h"
#include "stages/match_planes/match_planes_vk.h"
#include "stages/semi_global/semi_global_vk.h"
#include "stages/speckle/speckle_vk.h"
#include "stages/weighted_median/weighted_median_vk.h"

namespace duo::vk {

/// Kernels and memory of the matcher for pictures of one size; must outlive the recordings that use it.
class Sgm {
 public:
  /// GrayPair on the device; the inside pictures are there exactly if the setup is masked.
  struct Input {
    BufferView<std::uint8_t> left = {}, right = {}, left_inside = {}, right_inside = {};
  };
  /// Errors  more pixels times disparities than a buffer holds, the device lacks memory, or the driver refuses a kernel
  static Result<Sgm> make(const Device& device, const SgmParams& params, const MatchSetup& setup);
  /// SgmMatch on the device, of the size set up; confidence may be absent = not wanted.
  void record(Recorder& recorder, const Input& pair, BufferView<std::uint16_t> d_q4,
              BufferView<std::uint8_t> confidence = {}) const;

 private:
  /// SgmMaps, and the packed planes of both views.
  struct Maps {
    Buffer balanced, left_planes, right_planes, left_winner, right_winner, fine, checked;
  };
  static Result<Maps> make_maps(const Device& device, Size size);
  Result<void> make_stages(const Device& device, int max_disparity);
  void record_found(Recorder& recorder, const Input& pair, BufferView<std::uint8_t> margin) const;
  void record_cleaned(Recorder& recorder, const Input& pair, BufferView<std::uint16_t> d_q4) const;

  SgmParams params_;
  Size size_;
  bool masked_ = false;
  Maps maps_;
  Balance balance_;
  Balance::Scratch balance_scratch_;
  MatchPlanes match_planes_;
  SemiGlobal semi_global_;
  SemiGlobal::Scratch volumes_;
  CheckLeftRight check_;
  RemoveSpeckle remove_speckle_;
  RemoveSpeckle::Scratch speckle_scratch_;
  WeightedMedian weighted_median_;
  Kernel keep_confidence_;
};

}  // namespace duo::vk
