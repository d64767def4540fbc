// Every kind of output is made by the table, with the options of a run; one that cannot be made leaves nothing of the others.
#include "duoptic/sink_kinds.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/agree.h"
#include "tests/waving_clip.h"
#include "tests/write_media.h"

namespace duo {
namespace {

using namespace test;  // NOLINT: the clip of tests/waving_clip.h

Pipeline tracked() {
  PipelineSetup setup = pipeline_setup();
  setup.tracker = "arm";
  setup.frames.wants = {.color = true, .depth = true};
  Pipeline pipeline = opened(std::move(setup));
  EXPECT_EQ(*pipeline.next(), Next::kNew);
  return pipeline;
}

TEST(SinkKinds, EachIsMadeByTheTable) {
  const TempFolder folder;
  SinkTargets sinks;
  EXPECT_FALSE(sinks.wants_maps());
  for (std::size_t i = 0; i < sink_kinds().size(); ++i) {
    const SinkKind& kind = sink_kinds()[i];
    sinks.targets[i] = {kind.is_file() ? (folder / (std::string("out") + kind.target)).string() : kind.target};
  }
  EXPECT_TRUE(sinks.wants_maps() && sinks.writes_depth());
  EXPECT_EQ(sinks.sent_to_stdout(), 0);
  Pipeline pipeline = tracked();
  const auto notes = sinks.add_all_to(pipeline);
  ASSERT_TRUE(notes) << notes.error().what;
  ASSERT_TRUE(pipeline.write());
  ASSERT_TRUE(pipeline.finish_sinks());
  for (const SinkKind& kind : sink_kinds()) {
    const auto file = folder / (std::string("out") + kind.target);
    EXPECT_EQ(std::filesystem::exists(file), kind.is_file()) << kind.label;
  }
}

TEST(SinkKinds, OneThatCannotBeMadeLeavesNothing) {
  const TempFolder folder;
  SinkTargets sinks;
  sinks.targets[0] = {(folder / "people.jsonl").string()};
  sinks.targets[2] = {(folder / "no/people.csv").string()};
  sinks.targets[3] = {"-"};
  EXPECT_EQ(sinks.sent_to_stdout(), 1);
  {
    Pipeline pipeline = tracked();
    EXPECT_FALSE(sinks.add_all_to(pipeline));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "people.jsonl"));
}

}  // namespace
}  // namespace duo
