// Runs that find nothing say so, and why.
#include "pipeline/found_watch.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "duoptic/one_pair.h"
#include "duoptic/pipeline.h"
#include "duoptic/synthetic.h"

namespace duo {
namespace {

Image<Rgb8> of_level(Size size, std::uint8_t level) {
  Image<Rgb8> out(size);
  for (int y = 0; y < size.height; ++y) std::fill_n(out.row(y), size.width, Rgb8{level, level, level});
  return out;
}

/// Of which the first columns have a disparity.
Frame frame_with(Size size, int columns) {
  Frame frame;
  frame.disparity.origin = Image<std::uint8_t>(size);
  for (int y = 0; y < size.height; ++y) {
    std::fill_n(frame.disparity.origin.row(y), size.width, static_cast<std::uint8_t>(Origin::kNone));
    std::fill_n(frame.disparity.origin.row(y), columns, static_cast<std::uint8_t>(Origin::kMeasured));
  }
  return frame;
}

Pair pair_of_level(Size size, std::uint8_t level) {
  Pair pair;
  pair.left.pixels = of_level(size, level);
  pair.right.pixels = of_level(size, level);
  return pair;
}

std::string told(FoundWatch watch, const Frame& frame, const Pair& pair, int frames = 1, std::size_t people = 0,
                 bool cause_told = false) {
  for (int i = 0; i < frames; ++i) watch.see(frame, pair, people);
  watch.end();
  return watch.warning(cause_told);
}

TEST(FoundWatch, SaysWhyThereIsAlmostNothing) {
  const FoundWatch watch({}, {}, false);
  EXPECT_EQ(told(watch, frame_with({160, 120}, 160), pair_of_level({160, 120}, 100)), "");
  EXPECT_EQ(told(watch, frame_with({160, 120}, 16), pair_of_level({160, 120}, 100)), "");
  const std::string flat = told(watch, frame_with({160, 120}, 1), pair_of_level({160, 120}, 100));
  EXPECT_EQ(flat.find("almost nothing was found, 0.6 % of the pixels have a disparity: both pictures show no texture"), 0u)
      << flat;
  EXPECT_NE(told(watch, frame_with({160, 120}, 0), pair_of_level({160, 120}, 3)).find("both pictures are dark, 3 of 255"),
            std::string::npos);
  EXPECT_NE(told(watch, frame_with({16, 16}, 0), pair_of_level({16, 16}, 100)).find("16x16 pixels are too small"),
            std::string::npos);
  EXPECT_EQ(told(watch, frame_with({160, 120}, 0), pair_of_level({160, 120}, 3), 1, 0, true), "");
  EXPECT_EQ(told({}, frame_with({160, 120}, 0), pair_of_level({160, 120}, 3)), "");
}

TEST(FoundWatch, TheFirstPicturesMayBeDark) {
  FoundWatch watch({}, {}, false);
  const Frame nothing = frame_with({160, 120}, 0);
  watch.see(nothing, pair_of_level({160, 120}, 0), 0);
  EXPECT_NE(watch.warning(false).find("dark"), std::string::npos);
  watch.see(nothing, pair_of_level({160, 120}, 100), 0);
  EXPECT_EQ(watch.warning(false).find("dark"), std::string::npos);
  EXPECT_NE(watch.warning(false).find("no texture"), std::string::npos);
  for (int i = 0; i < 8; ++i) watch.see(frame_with({160, 120}, 100), pair_of_level({160, 120}, 100), 0);
  EXPECT_EQ(watch.warning(false), "");
}

TEST(FoundWatch, NobodyIsSaidToo) {
  const FoundWatch watch({}, {}, true);
  const Frame whole = frame_with({160, 120}, 160);
  const Pair room = pair_of_level({160, 120}, 100);
  EXPECT_EQ(told(watch, whole, room, 3, 1), "");
  EXPECT_EQ(told(watch, whole, room, 3).find("nobody was found in 3 frames: the networks know no person"), 0u);
  EXPECT_EQ(told(watch, whole, room, 3, 0, true), "nobody was found in 3 frames");
  FoundWatch goes_on({}, {}, true);
  goes_on.see(whole, room, 0);
  EXPECT_EQ(goes_on.warning(false), "");
  const std::string dark = told(watch, frame_with({160, 120}, 0), pair_of_level({160, 120}, 2));
  EXPECT_EQ(dark.find("nobody was found in 1 frame: both pictures are dark"), 0u) << dark;
  // Of frames that were matched in part nothing is known elsewhere.
  Frame part = frame_with({160, 120}, 0);
  part.matched = {0, 0, 10, 10};
  EXPECT_NE(told(watch, part, pair_of_level({160, 120}, 2)).find("the networks know no person"), std::string::npos);
}

/// A room searched by too few disparities, through the pipeline.
TEST(FoundWatch, ASceneThatIsTooNearIsTold) {
  const SyntheticPair room = render_synthetic({.size = {320, 240}, .ideal = true}, 2);
  const auto run = [&](int max_disparity, bool with_rig, std::vector<Window> windows = {}) {
    Pair pair;
    pair.left.pixels = room.pair.left.pixels.clone();
    pair.right.pixels = room.pair.right.pixels.clone();
    PipelineSetup setup{.engine = "ref", .threads = 1};
    if (with_rig) setup.frames.rig = room.rig;
    setup.frames.max_disparity = max_disparity;
    auto pipeline = Pipeline::open(one_pair(std::move(pair)), std::move(setup));
    EXPECT_TRUE(pipeline);
    pipeline->look_at(windows);
    EXPECT_TRUE(pipeline->next());
    return pipeline->warning();
  };
  EXPECT_EQ(run(64, false), "");
  const std::string near = run(4, false), with_rig = run(4, true);
  EXPECT_NE(near.find("nearer than what is searched, 4 px of disparity, and depth is wrong there: give --max-disparity "),
            std::string::npos)
      << near;
  EXPECT_NE(with_rig.find("4 px of disparity or "), std::string::npos) << with_rig;
  EXPECT_EQ(run(4, false, {{10, 10, 20, 20}}), "");
  // Of several frames that one is named, by its number in the file.
  duo::Setup four;
  four.max_disparity = 4;
  FoundWatch watch(four, {}, false);
  Pair pair;
  pair.left.pixels = room.pair.left.pixels.clone();
  pair.right.pixels = room.pair.right.pixels.clone();
  pair.sequence = 30;
  for (int i = 0; i < 2; ++i) watch.see(frame_with({320, 240}, 320), pair, 0);
  EXPECT_EQ(watch.warning(false).find("in frame 30 "), 0u) << watch.warning(false);
}

}  // namespace
}  // namespace duo
