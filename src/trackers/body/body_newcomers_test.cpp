// The body tracker in the first frames of a person.
#include <gtest/gtest.h>

#include "tests/allocations.h"
#include "trackers/body/rendered_person.h"

namespace duo {
namespace {

using test::body_tracker, test::copy_of, test::kFrames, test::RenderedPerson;

/// What no network sees anybody in.
Frame dark_frame() {
  Frame dark = copy_of(*RenderedPerson::get().frames[0]);
  for (int y = 0; y < dark.color.height(); ++y)
    for (int x = 0; x < dark.color.width(); ++x) dark.color.at(y, x) = {};
  return dark;
}

/// How many frames pass before somebody is forgotten who is not seen any more.
int frames_until_forgotten(int seen_in) {
  constexpr int kMost = 100;
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  for (int i = 0; i < seen_in; ++i) EXPECT_EQ(tracker->track(*person.frames[static_cast<std::size_t>(i)]).size(), 1u);
  const Frame dark = dark_frame();
  for (int i = 0; i < kMost; ++i)
    if (tracker->track(dark).empty()) return i;
  return kMost;
}

// Frames in which nobody sees it say nothing for it.
TEST(BodyNewcomers, WhoWasSeenOnceIsForgottenSoon) {
  EXPECT_EQ(frames_until_forgotten(1), 15);
  EXPECT_EQ(frames_until_forgotten(kFrames - 1), 15);
  EXPECT_EQ(frames_until_forgotten(kFrames), 75);
}

TEST(BodyNewcomers, AllocateNothingFromTheSecondFrameOn) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  tracker->track(*person.frames[0]);
  const long before = test::allocations;
  for (const auto& frame : person.frames) tracker->track(*frame);
  EXPECT_EQ(test::allocations - before, 0);
}

}  // namespace
}  // namespace duo
