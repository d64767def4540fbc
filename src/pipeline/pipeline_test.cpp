// The whole way of a frame: each pair of files once, in order, with the same bits for any number of threads; the newest of a
// live source; the right picture at the left one's capture time whoever asks; other parameters on the way; sinks; failures as
// results.
#include "duoptic/pipeline.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include "duoptic/synthetic.h"
#include "pipeline/tracked_setup.h"
#include "tests/agree.h"
#include "tests/allocations.h"
#include "tests/waving_clip.h"
#include "tests/write_media.h"

namespace duo {
namespace {

using namespace std::chrono_literals;

using namespace test;  // NOLINT: the clip of tests/waving_clip.h

TEST(Pipeline, EachPairOfFilesOnceInOrderWithTheSameBits) {
  const auto want = frames_of(pipeline_setup());
  ASSERT_EQ(want.size(), std::size_t{kClipPairs});
  for (std::size_t i = 0; i < want.size(); ++i) EXPECT_EQ(want[i]->sequence, i);
  for (const int threads : {1, 2, 3, 7})
    for (const bool many : {false, true}) {
      const auto got = frames_of(pipeline_setup(threads, many));
      ASSERT_EQ(got.size(), want.size());
      for (std::size_t i = 0; i < want.size(); ++i)
        expect_same_maps(*want[i], *got[i], std::to_string(threads) + " threads, frame " + std::to_string(i));
    }
}

// Depth alone and tracking see the same frames: pairs that are not in step are put to one moment for both. Without that they
// would be others.
TEST(Pipeline, AlignsInTimeWithAndWithoutATracker) {
  const auto depth = frames_of(pipeline_setup());
  PipelineSetup tracking = pipeline_setup(2, true);
  tracking.tracker = "arm";
  const auto tracked = frames_of(std::move(tracking));
  ASSERT_EQ(depth.size(), tracked.size());
  const auto engine = *make_engine("simd", 1);
  duo::Setup setup = pipeline_setup().frames;
  setup.size = kClipSize;
  setup.rig = clip_rig();
  ASSERT_TRUE(engine->prepare(setup));
  int moved = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    EXPECT_EQ(depth[i]->skew_ns, 12'000'000);
    expect_same_maps(*depth[i], *tracked[i], "frame " + std::to_string(i));
    engine->submit(clip()[i]);
    const auto as_it_came = engine->collect();
    for (int y = 0; y < as_it_came->right.height(); ++y)
      for (int x = 0; x < as_it_came->right.width(); ++x) moved += as_it_came->right.at(y, x) != depth[i]->right.at(y, x);
  }
  EXPECT_GT(moved, 1000);
}

TEST(Pipeline, PairsComeAsTheyWere) {
  Pipeline pipeline = opened(pipeline_setup());
  for (const Pair& want : clip()) {
    ASSERT_EQ(*pipeline.next(), Next::kNew);
    const Pair& got = *pipeline.pair();
    for (int y = 0; y < kClipSize.height; ++y) {
      ASSERT_TRUE(std::equal(want.right.pixels.row(y), want.right.pixels.row(y) + kClipSize.width, got.right.pixels.row(y)));
      ASSERT_TRUE(std::equal(want.left.pixels.row(y), want.left.pixels.row(y) + kClipSize.width, got.left.pixels.row(y)));
    }
  }
}

// What is passed over still says how things moved.
TEST(Pipeline, FirstAndEveryChooseFrames) {
  const auto all = frames_of(pipeline_setup());
  PipelineSetup setup = pipeline_setup();
  setup.first = 2;
  setup.every = 3;
  Pipeline pipeline = opened(std::move(setup));
  const auto chosen = frames_of(pipeline);
  ASSERT_EQ(chosen.size(), 3U);
  for (std::size_t i = 0; i < chosen.size(); ++i) expect_same_maps(*all[2 + 3 * i], *chosen[i], "choice " + std::to_string(i));
  EXPECT_EQ(pipeline.read(), kClipPairs);
}

TEST(Pipeline, ARestartBeginsAtAnyPair) {
  const auto all = frames_of(pipeline_setup());
  Pipeline pipeline = opened(pipeline_setup());
  ASSERT_EQ(*pipeline.next(), Next::kNew);
  for (const std::int64_t first : {6, 2, 0}) {
    ASSERT_TRUE(pipeline.restart(std::make_unique<Clip>(), first));
    const auto rest = frames_of(pipeline);
    ASSERT_EQ(static_cast<std::int64_t>(rest.size()), kClipPairs - first);
    for (std::size_t i = 0; i < rest.size(); ++i)
      expect_same_maps(*all[static_cast<std::size_t>(first) + i], *rest[i], "from " + std::to_string(first));
  }
}

// The frame at hand and those that were already made ahead are made anew; a setup that is refused changes nothing.
TEST(Pipeline, OtherParametersOnTheWay) {
  const std::vector<std::pair<std::string, double>> other = {{"levels", 1}};
  PipelineSetup changed = pipeline_setup();
  changed.frames.parameters = other;
  const auto before = frames_of(pipeline_setup()), after = frames_of(std::move(changed));
  for (const bool many : {false, true}) {
    Pipeline pipeline = opened(pipeline_setup(3, many));
    for (std::size_t i = 0; i < before.size(); ++i) {
      ASSERT_EQ(*pipeline.next(), Next::kNew);
      const std::string who = (many ? "many, frame " : "frame ") + std::to_string(i);
      if (i == 4) {
        expect_same_maps(*before[i], *pipeline.frame(), who + " before");
        EXPECT_FALSE(pipeline.set({{"levels", 99}}));
        expect_same_maps(*before[i], *pipeline.frame(), who + " after a refusal");
        const auto shared = pipeline.pair();
        ASSERT_TRUE(pipeline.set(other));
        EXPECT_EQ(shared, pipeline.pair());
      }
      expect_same_maps(i < 4 ? *before[i] : *after[i], *pipeline.frame(), who);
    }
    EXPECT_EQ(*pipeline.next(), Next::kEnd);
  }
}

TEST(Pipeline, TrackersGetWhatTheyWereMeasuredOnUnlessItIsNamed) {
  duo::Setup wanted;
  wanted.matcher = "sgm";
  const std::vector<std::pair<std::string, double>> without = {{"refine", 0}, {"even", 0}},
                                                    named = {{"refine", 0}, {"even", 0}, {"refine", 1}};
  EXPECT_EQ(setup_of_tracked(wanted).parameters, without);
  wanted.parameters = {{"refine", 1}};
  EXPECT_EQ(setup_of_tracked(wanted).parameters, named);  // the last one counts
  wanted = {};
  wanted.matcher = "pyramid";
  EXPECT_TRUE(setup_of_tracked(wanted).parameters.empty());
}

TEST(Pipeline, AllocatesNothingPerFrame) {
  constexpr int kFirst = 20, kFrames = 100;
  for (const bool many : {false, true}) {
    Pipeline pipeline = opened(pipeline_setup(2, many), std::make_unique<Clip>(kFirst + kFrames));
    for (int i = 0; i < kFirst; ++i) ASSERT_EQ(*pipeline.next(), Next::kNew);
    const long before = test::allocations;
    for (int i = 0; i < kFrames; ++i) ASSERT_EQ(*pipeline.next(), Next::kNew);
    EXPECT_EQ(test::allocations - before, 0) << (many ? "many at once" : "one at once");
  }
}

/// Counts what it is given; may fail at a frame.
class Counts final : public Sink {
 public:
  explicit Counts(std::vector<std::int64_t>& numbers, std::int64_t fails_at = -1) : numbers_(numbers), fails_at_(fails_at) {}
  Result<void> write(const TrackedFrame& frame) override {
    if (frame.number == fails_at_) return Error{ErrorCode::kWriteFailed, "full"};
    numbers_.push_back(frame.number);
    return {};
  }
  Result<void> finish() override {
    numbers_.push_back(-1);
    return {};
  }

 private:
  std::vector<std::int64_t>& numbers_;
  std::int64_t fails_at_;
};

TEST(Pipeline, ASinkThatFailsIsGivenUpAndNumbersGoOnAfterARestart) {
  std::vector<std::int64_t> good, bad, ended;
  Pipeline pipeline = opened(pipeline_setup(), std::make_unique<Clip>(3));
  ASSERT_TRUE(pipeline.add_sink("good", std::make_unique<Counts>(good)));
  ASSERT_TRUE(pipeline.add_sink("bad", std::make_unique<Counts>(bad, 1)));
  ASSERT_TRUE(pipeline.add_sink("ended", std::make_unique<Counts>(ended)));
  for (int round = 0; round < 2; ++round) {
    for (int i = 0; i < 3; ++i) {
      ASSERT_EQ(*pipeline.next(), Next::kNew);
      EXPECT_EQ(pipeline.tracked().number, i);
      EXPECT_EQ(pipeline.write().has_value(), round > 0 || i != 1);
    }
    EXPECT_EQ(*pipeline.next(), Next::kEnd);
    EXPECT_FALSE(pipeline.has_sink("bad"));
    if (round > 0) break;
    ASSERT_TRUE(pipeline.finish_sink("ended"));
    ASSERT_TRUE(pipeline.restart(std::make_unique<Clip>(3)));
  }
  ASSERT_TRUE(pipeline.finish_sinks());
  EXPECT_EQ(good, (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, -1}));
  EXPECT_EQ(bad, (std::vector<std::int64_t>{0}));
  EXPECT_EQ(ended, (std::vector<std::int64_t>{0, 1, 2, -1}));
}

// Whoever looks slowly gets the newest; the others are counted, and all are in the recording.
TEST(Pipeline, OfALiveSourceTheNewestAndAllAreRecorded) {
  constexpr int kLive = 30;
  const test::TempFolder folder;
  std::atomic<int> given = 0;
  Pipeline pipeline =
      opened(pipeline_setup(2, true), std::make_unique<Clip>(kLive, true, [&](int number) { given = number + 1; }));
  ASSERT_TRUE(pipeline.record(folder / "clip.mkv", {}));
  std::vector<std::uint64_t> numbers;
  while (true) {
    const auto next = pipeline.next();
    ASSERT_TRUE(next) << next.error().what;
    if (*next == Next::kEnd) break;
    if (*next != Next::kNew) continue;
    numbers.push_back(pipeline.pair()->sequence);
    while (given < kLive) std::this_thread::sleep_for(1ms);  // looks at its first frame until all were given
  }
  pipeline.stop_recording();
  EXPECT_TRUE(std::is_sorted(numbers.begin(), numbers.end()));
  EXPECT_LT(numbers.size(), 6U);  // the first, those that were ready or at hand by then, and the newest
  EXPECT_EQ(numbers.back(), std::uint64_t{kLive - 1});
  EXPECT_EQ(static_cast<std::int64_t>(numbers.size()) + pipeline.dropped(), kLive);
  EXPECT_EQ(pipeline.recording().pairs, kLive);
  EXPECT_FALSE(pipeline.recording_failure());
}

TEST(Pipeline, PairsAloneForWhoRecords) {
  const test::TempFolder folder;
  PipelineSetup setup;
  setup.engine.clear();
  Pipeline pipeline = opened(std::move(setup));
  ASSERT_TRUE(pipeline.record(folder / "clip.mkv", {.rig = clip_rig()}));
  int pairs = 0;
  while (*pipeline.next() == Next::kNew) {
    EXPECT_EQ(pipeline.frame(), nullptr);
    EXPECT_EQ(pipeline.pair()->sequence, static_cast<std::uint64_t>(pairs++));
  }
  pipeline.stop_recording();
  EXPECT_EQ(pairs, kClipPairs);
  const auto report = inspect_recording(folder / "clip.mkv");
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_EQ(report->pairs, kClipPairs);
  EXPECT_NEAR(report->skew_s, kSkew_s, 1e-9);
}

TEST(Pipeline, WhatASourceThrowsIsAnErrorAfterTheFramesBeforeIt) {
  for (const bool live : {false, true}) {
    Pipeline pipeline = opened(pipeline_setup(), std::make_unique<Clip>(kClipPairs, live, [](int i) {
                                 if (i == 3) throw std::bad_alloc();
                                 std::this_thread::sleep_for(20ms);
                               }));
    Result<Next> next = Next::kNothing;
    int frames = 0;
    while ((next = pipeline.next()) && *next != Next::kEnd) frames += *next == Next::kNew;
    ASSERT_FALSE(next);
    EXPECT_NE(next.error().what.find("out of memory"), std::string::npos) << next.error().what;
    EXPECT_LE(frames, 3);
    EXPECT_GE(frames, live ? 0 : 3);
  }
}

// It is let go in whatever state: never asked, in the middle, with frames that are held.
TEST(Pipeline, MayBeLeftAtAnyTime) {
  std::shared_ptr<const Frame> kept;
  for (int frames = 0; frames < 4; ++frames)
    for (const bool live : {false, true}) {
      Pipeline pipeline = opened(pipeline_setup(3, true), std::make_unique<Clip>(kClipPairs, live));
      for (int i = 0; i < frames && *pipeline.next() == Next::kNew;) i += 1;
      kept = pipeline.frame();
    }
  EXPECT_TRUE(kept != nullptr && !kept->disparity.d_q4.empty());
}

TEST(Pipeline, RefusesWhatCannotWork) {
  PipelineSetup setup = pipeline_setup();
  setup.engine = "guess";
  EXPECT_FALSE(Pipeline::open(std::make_unique<Clip>(), setup));
  setup = pipeline_setup();
  setup.tracker = "guess";
  EXPECT_FALSE(Pipeline::open(std::make_unique<Clip>(), setup));
  setup = pipeline_setup();
  setup.frames.matcher = "guess";
  EXPECT_FALSE(Pipeline::open(std::make_unique<Clip>(), setup));
  Pipeline pipeline = opened(pipeline_setup());
  EXPECT_FALSE(pipeline.record("/nowhere/clip.mkv", {}));
  EXPECT_NE(pipeline.recording().problem, "");
}

}  // namespace
}  // namespace duo
