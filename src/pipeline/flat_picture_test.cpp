#include "pipeline/flat_picture.h"

#include <gtest/gtest.h>

#include <random>

#include "duoptic/pipeline.h"
#include "duoptic/synthetic.h"

namespace duo {
namespace {

constexpr Size kSize{160, 120};

/// Brightness `level(x, y)` with noise of this standard deviation.
template <class Level>
Image<Rgb8> picture(Level&& level, double noise) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, noise);
  Image<Rgb8> out(kSize);
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const auto value = [&] {
        return static_cast<std::uint8_t>(std::clamp(level(x, y) + (noise > 0 ? normal(random) : 0), 0.0, 255.0));
      };
      out.at(y, x) = {value(), value(), value()};
    }
  return out;
}

TEST(FlatPicture, CapsBlankWallsAndNoiseAreFlat) {
  for (const double noise : {0.0, 1.0, 3.0, 8.0}) {
    EXPECT_TRUE(is_flat(picture([](int, int) { return 0.0; }, noise).view())) << noise;
    EXPECT_TRUE(is_flat(picture([](int, int) { return 128.0; }, noise).view())) << noise;
    EXPECT_TRUE(is_flat(picture([](int x, int y) { return 200 - 0.3 * x - 0.2 * y; }, noise).view())) << noise;  // light
  }
}

TEST(FlatPicture, WhatHasEdgesOrTextureIsNot) {
  for (const double noise : {0.0, 3.0}) {
    EXPECT_FALSE(is_flat(picture([](int x, int) { return x < 80 ? 100.0 : 130.0; }, noise).view())) << noise;
    EXPECT_FALSE(
        is_flat(picture([](int x, int y) { return x > 60 && x < 80 && y > 50 && y < 70 ? 160.0 : 100.0; }, noise).view()))
        << noise;
  }
  const SyntheticPair room = render_synthetic({.size = kSize}, 1);
  EXPECT_FALSE(is_flat(room.pair.left.pixels.view()));
}

/// Pairs of a room of which one camera is covered in every other pair.
class HalfCovered final : public PairSource {
 public:
  Size size() const override { return kSize; }
  std::int64_t count() const override { return 4; }
  bool still() const override { return false; }
  std::string warning() const override { return {}; }
  Result<Next> next(Pair& into) override {
    if (given_ == 4) return Next::kEnd;
    const SyntheticPair room = render_synthetic({.size = kSize}, 1);
    into.left.pixels = room.pair.left.pixels.clone();
    into.right.pixels = given_ % 2 == 0 ? picture([](int, int) { return 4.0; }, 1) : room.pair.right.pixels.clone();
    into.sequence = given_++;
    return Next::kNew;
  }

 private:
  std::uint64_t given_ = 0;
};

TEST(FlatPicture, HasNoDepth) {
  PipelineSetup setup{.engine = "simd", .threads = 1};
  setup.frames.rig = synthetic_rig({.size = kSize});
  setup.frames.wants = {.depth = true, .confidence = true};
  setup.frames.max_disparity = 48;
  auto pipeline = Pipeline::open(std::make_unique<HalfCovered>(), setup);
  ASSERT_TRUE(pipeline) << pipeline.error().what;
  for (int i = 0; i < 4; ++i) {
    const auto next = pipeline->next();
    ASSERT_TRUE(next && *next == Next::kNew);
    const Frame& frame = *pipeline->frame();
    EXPECT_EQ(frame.sequence, static_cast<std::uint64_t>(i));
    const Size size = frame.disparity.d_q4.size();
    int known = 0;
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const bool is_known = frame.disparity.d_q4.at(y, x) != Disparity::kNone;
        EXPECT_EQ(is_known, frame.disparity.origin.at(y, x) != static_cast<std::uint8_t>(Origin::kNone));
        EXPECT_EQ(is_known, frame.confidence.at(y, x) > 0);
        known += is_known;
      }
    EXPECT_EQ(known > 0, i % 2 == 1) << i;
    EXPECT_EQ(frame.left.empty(), false);
  }
}

}  // namespace
}  // namespace duo
