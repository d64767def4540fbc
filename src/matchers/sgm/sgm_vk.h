// The semi-global matcher on a device. README.md beside this file tells the method, sgm_ref.cpp the order of its stages.
#pragma once

#include "matchers/match_vk.h"
#include "matchers/sgm/sgm.h"
#include "stages/balance/balance_vk.h"
#include "stages/bilateral/bilateral_vk.h"
#include "stages/blur/blur_vk.h"
#include "stages/check_left_right/check_left_right_vk.h"
#include "stages/lucas_kanade/lucas_kanade_vk.h"
#include "stages/match_planes/match_planes_vk.h"
#include "stages/noise/noise_vk.h"
#include "stages/semi_global/semi_global_vk.h"
#include "stages/speckle/speckle_vk.h"
#include "stages/weighted_median/weighted_median_vk.h"

namespace duo::vk {

/// Kernels and memory of the matcher for pictures of one size; must outlive the recordings that use it. All of them are of one
/// stream, and are submitted in the order of its pairs.
class Sgm {
 public:
  using Input = MatchInput;
  using Output = MatchOutput;
  /// Errors  more pixels times disparities than a buffer holds, the device lacks memory, or the driver refuses a kernel
  static Result<Sgm> make(Device& device, const SgmParams& params, const MatchSetup& setup);
  /// Disparity of the left picture in 1/16 px; all pictures of the size set up.
  void record(Recorder& recorder, const Input& pair, const Output& out) const;

 private:
  /// The maps between the stages, and the stages' own memory.
  struct Maps {
    Buffer balanced, noise_q4, blur_q4, not_coded, stream, soft_left, soft_right, left_planes, right_planes, left_winner,
        right_winner, fine, checked;
    Balance::Scratch balance;
    Noise::Scratch noise;
    Blur::Scratch blur;
    SemiGlobal::Scratch semi_global;
    RemoveSpeckle::Scratch speckle;
  };
  static Result<Maps> make_maps(Device& device, const SgmParams& params, const MatchSetup& setup);
  void record_winners(Recorder& recorder, const Input& pair, BufferView<std::uint8_t> margin) const;
  /// The left picture as it is matched.
  BufferView<std::uint8_t> left_of(const Input& pair) const {
    return params_.soften != 0 ? whole<std::uint8_t>(maps_.soft_left) : pair.left;
  }
  BufferView<std::uint8_t> right_as_matched() const {
    return whole<std::uint8_t>(params_.soften != 0 ? maps_.soft_right : maps_.balanced);
  }
  template <class T>
  BufferView<T> whole(const Buffer& buffer) const {
    return {buffer, {0, setup_.size.width}};
  }

  SgmParams params_;
  MatchSetup setup_;
  Maps maps_;
  Balance balance_;
  Noise noise_;
  Blur blur_;
  Bilateral bilateral_;
  MatchPlanes match_planes_;
  SemiGlobal semi_global_;
  CheckLeftRight check_left_right_;
  RemoveSpeckle remove_speckle_;
  WeightedMedian weighted_median_;
  LucasKanade lucas_kanade_;
  Kernel keep_confidence_, settle_clear_;
};

}  // namespace duo::vk
