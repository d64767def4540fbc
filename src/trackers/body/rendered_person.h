// Frames of a rendered person for tests of the tracker `body`.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "duoptic/engine.h"
#include "duoptic/synthetic.h"
#include "duoptic/tracker.h"
#include "trackers/body/body_tracker.h"

namespace duo::test {

inline constexpr int kFrames = 10;

/// Frames of a rendered person, made once for all tests.
struct RenderedPerson {
  Rig rig;
  Rectified rectified;
  std::vector<std::shared_ptr<const Frame>> frames;
  std::vector<std::vector<SyntheticJoint>> joints;

  static const RenderedPerson& get() {
    static const RenderedPerson person;
    return person;
  }

 private:
  RenderedPerson() {
    auto clip = SyntheticClip::open({.size = {320, 240}, .seed = 5, .script = "wave", .frames = kFrames}, 2);
    EXPECT_TRUE(clip) << (clip ? "" : clip.error().what);
    auto engine = make_engine("simd", 2);
    rig = clip->rig();
    Setup setup;
    setup.size = {320, 240};
    setup.rig = rig;
    setup.max_disparity = 64;
    setup.wants.color = true;
    setup.parameters = {{"refine", 0}, {"even", 0}};  // as for all trackers
    const auto prepared = (*engine)->prepare(setup);
    EXPECT_TRUE(prepared) << (prepared ? "" : prepared.error().what);
    rectified = *(*engine)->rectified();
    for (int i = 0; i < kFrames; ++i) {
      SyntheticClipFrame frame = clip->frame(i);
      (*engine)->submit(frame.pair);
      frames.push_back((*engine)->collect());
      joints.push_back(std::move(frame.joints));
    }
  }
};

inline std::unique_ptr<Tracker> body_tracker(const Rig& rig, const Rectified& rectified, int threads) {
  auto tracker = make_body_tracker();
  const auto prepared =
      tracker->prepare({.rig = rig, .rectified = rectified, .threads = threads, .body_model = BodyModel::kLite});
  EXPECT_TRUE(prepared) << (prepared ? "" : prepared.error().what);
  return tracker;
}

inline Frame copy_of(const Frame& frame) {
  Frame out;
  out.color = frame.color.clone();
  out.disparity.d_q4 = frame.disparity.d_q4.clone();
  return out;
}

}  // namespace duo::test
