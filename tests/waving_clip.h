// A waving person whose right pictures are taken 12 ms late, as a source that is a file or live.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "duoptic/pipeline.h"
#include "duoptic/synthetic.h"

namespace duo::test {

inline constexpr Size kClipSize = {160, 120};
inline constexpr int kClipPairs = 9;
inline constexpr double kSkew_s = 0.012;

inline SyntheticClip late_clip() {
  auto made = SyntheticClip::open({.size = kClipSize, .script = "wave", .frames = 40, .skew_s = kSkew_s}, 2);
  EXPECT_TRUE(made);
  return std::move(*made);
}
/// A waving person whose right pictures are taken 12 ms late.
inline const std::vector<Pair>& clip() {
  static const std::vector<Pair> pairs = [] {
    SyntheticClip made = late_clip();
    std::vector<Pair> out;
    for (int i = 0; i < kClipPairs; ++i) {
      out.push_back(made.frame(17 + i).pair);  // the hand is up and moves
      out.back().sequence = static_cast<std::uint64_t>(i);
    }
    return out;
  }();
  return pairs;
}
inline const Rig& clip_rig() {
  static const Rig rig = late_clip().rig();
  return rig;
}

inline void copy_pair(const Pair& from, Pair& to) {
  for (Picture Pair::*side : {&Pair::left, &Pair::right}) {
    const Picture& picture = from.*side;
    Picture& copy = to.*side;
    if (copy.pixels.size() != picture.pixels.size()) copy.pixels = Image<Rgb8>(picture.pixels.size());
    for (int y = 0; y < picture.pixels.height(); ++y)
      std::copy_n(picture.pixels.row(y), picture.pixels.width(), copy.pixels.row(y));
    copy.t_ns = picture.t_ns;
    copy.sequence = picture.sequence;
  }
  to.sequence = from.sequence;
}

/// The clip, over and over until `count` pairs were given; `meanwhile` is called before each.
class Clip final : public PairSource {
 public:
  explicit Clip(int count = kClipPairs, bool live = false, std::function<void(int)> meanwhile = {})
      : count_(count), live_(live), meanwhile_(std::move(meanwhile)) {}
  Size size() const override { return kClipSize; }
  std::int64_t count() const override { return live_ ? 0 : count_; }
  bool still() const override { return false; }
  std::optional<Rig> rig() const override { return clip_rig(); }
  bool live() const override { return live_; }
  std::string warning() const override { return {}; }
  Result<Next> next(Pair& into) override {
    if (given_ == count_) return Next::kEnd;
    if (meanwhile_) meanwhile_(given_);
    const auto i = static_cast<std::size_t>(given_ % kClipPairs);
    copy_pair(clip()[i], into);
    const TimeNs round_ns = given_ / kClipPairs * TimeNs{kClipPairs} * 33'333'333;
    into.left.t_ns += round_ns;
    into.right.t_ns += round_ns;
    into.sequence = static_cast<std::uint64_t>(given_++);
    return Next::kNew;
  }

 private:
  const int count_;
  const bool live_;
  const std::function<void(int)> meanwhile_;
  int given_ = 0;
};

inline PipelineSetup pipeline_setup(int threads = 1, bool many_at_once = false) {
  PipelineSetup setup;
  setup.engine = "simd";
  setup.threads = threads;
  setup.frames.matcher = "pyramid";
  setup.frames.max_disparity = 32;
  setup.frames.many_at_once = many_at_once;
  return setup;
}

inline Pipeline opened(PipelineSetup setup, std::unique_ptr<PairSource> pairs = std::make_unique<Clip>()) {
  auto pipeline = Pipeline::open(std::move(pairs), std::move(setup));
  EXPECT_TRUE(pipeline) << pipeline.error().what;
  return std::move(*pipeline);
}

/// Every frame up to the end, all of them held at once.
inline std::vector<std::shared_ptr<const Frame>> frames_of(Pipeline& pipeline) {
  std::vector<std::shared_ptr<const Frame>> out;
  while (true) {
    const auto next = pipeline.next();
    EXPECT_TRUE(next) << next.error().what;
    if (!next || *next != Next::kNew) return out;
    EXPECT_EQ(pipeline.frame()->sequence, pipeline.pair()->sequence);
    out.push_back(pipeline.frame());
  }
}
inline std::vector<std::shared_ptr<const Frame>> frames_of(PipelineSetup setup) {
  Pipeline pipeline = opened(std::move(setup));
  return frames_of(pipeline);
}

inline void expect_same_maps(const Frame& want, const Frame& got, const std::string& who) {
  EXPECT_EQ(want.sequence, got.sequence) << who;
  EXPECT_EQ(want.skew_ns, got.skew_ns) << who;
  test::expect_same<std::uint8_t>(want.right, got.right, who + " right");
  test::expect_same<std::uint16_t>(want.disparity.d_q4, got.disparity.d_q4, who + " disparity");
}

}  // namespace duo::test
