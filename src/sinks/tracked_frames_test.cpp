// Sinks that take frame after frame: their bytes by hand, and what is on the disk before, after and instead of the end.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>

#include "duoptic/sink.h"
#include "duoptic/source.h"
#include "sinks/video_writer.h"
#include "tests/moment.h"
#include "tests/write_media.h"

namespace duo {
namespace {

using namespace test;  // NOLINT: the persons

constexpr char kHeader[] =
    R"({"type":"header","version":2,"units":{"length":"m","time":"s","uv":"px of the raw left picture"},)"
    R"("rig_from_left":[1.000000000,0.000000000,0.000000000,0.000000000,1.000000000,0.000000000,0.000000000,0.000000000,)"
    R"(1.000000000],"focal_px":500.0000,"baseline_m":0.125000,"sources":["left.avi","odd \"name\"�.avi"],"engine":"simd","device":null,)"
    R"("matcher":"pyramid","matcher_preset":"default","tracker":"arm","skeletons":{"right_arm":[)"
    R"({"id":9,"name":"right_shoulder","parent":null,"side":"right"},{"id":10,"name":"right_elbow","parent":"right_shoulder",)"
    R"("side":"right"},{"id":12,"name":"right_hand","parent":"right_elbow","side":"right"}]},"width":64,"height":48,)"
    R"("frame_s":0.033333})"
    "\n";
constexpr char kPerson[] =
    R"({"id":1,"skeleton":"right_arm","joints":{"right_shoulder":{"p_in_rig_m":null,"uv_left_px":null,"state":"lost",)"
    R"("confidence":0.000,"sigma_m":1.5000},"right_elbow":{"p_in_rig_m":[0.0000,0.0000,2.0000],"uv_left_px":[12.35,24.00],)"
    R"("state":"inferred","confidence":0.250,"sigma_m":0.2500},"right_hand":{"p_in_rig_m":[0.1000,-0.2500,1.5000],)"
    R"("uv_left_px":[30.00,20.50],"state":"seen","confidence":0.900,"sigma_m":0.0125}}})";

TEST(JsonLines, BytesByHand) {
  const test::TempFolder folder;
  const Moment moment({64, 48});
  auto sink = make_json_lines(folder / "arm.jsonl", clip_header({64, 48}));
  ASSERT_TRUE(sink) << sink.error().what;
  ASSERT_TRUE((*sink)->write(moment.tracked(57)));
  TrackedFrame timed = moment.tracked(58);
  timed.times = TrackTimes{12.3456, 1};
  ASSERT_TRUE((*sink)->write(timed));
  EXPECT_FALSE(std::filesystem::exists(folder / "arm.jsonl"));  // not before its end
  ASSERT_TRUE((*sink)->finish());
  const std::string person = kPerson;
  EXPECT_EQ(bytes_of(folder / "arm.jsonl"), kHeader +
                                                (R"({"type":"frame","frame":57,"t_s":1.900000,"people":[)" + person + "]}\n") +
                                                (R"({"type":"frame","frame":58,"t_s":1.933333,"people":[)" + person +
                                                 R"(],"engine_ms":12.346,"tracker_ms":1.000})" + "\n"));
}

TEST(JsonLines, SayWhatWasMatchedAroundPeopleAlone) {
  const test::TempFolder folder;
  TrackHeader header = clip_header({64, 48});
  header.focus = true;
  auto sink = make_json_lines(folder / "arm.jsonl", header);
  ASSERT_TRUE(sink);
  ASSERT_TRUE((*sink)->finish());
  EXPECT_NE(bytes_of(folder / "arm.jsonl").find(R"("tracker":"arm","focus":true,"skeletons":{)"), std::string::npos);
}

TEST(JsonLines, SeveralPersonsAndNone) {
  const test::TempFolder folder;
  Moment moment({64, 48});
  auto sink = make_json_lines(folder / "arm.jsonl", clip_header({64, 48}));
  ASSERT_TRUE(sink);
  moment.people.push_back(moment.people[0]);
  ASSERT_TRUE((*sink)->write(moment.tracked(0)));
  moment.people.clear();
  ASSERT_TRUE((*sink)->write(moment.tracked(1)));
  ASSERT_TRUE((*sink)->finish());
  const std::string person = kPerson;
  EXPECT_EQ(bytes_of(folder / "arm.jsonl"),
            kHeader + (R"({"type":"frame","frame":0,"t_s":0.000000,"people":[)" + person + "," + person + "]}\n") +
                R"({"type":"frame","frame":1,"t_s":0.033333,"people":[]})" + "\n");
}

/// By hand: the tips of one hand are 3 cm apart, the other one's are lost.
TEST(JsonLines, APersonWithFingersHasAPinch) {
  const test::TempFolder folder;
  Moment moment({64, 48});
  Person person = person_with(kBodyHands);
  joint_of(person, JointId::kRightThumbTip) = joint({0.1, 0, 2});
  joint_of(person, JointId::kRightIndexTip) = joint({0.13, 0, 2});
  moment.people = {person};
  auto sink = make_json_lines(folder / "hands.jsonl", clip_header({64, 48}));
  ASSERT_TRUE(sink);
  ASSERT_TRUE((*sink)->write(moment.tracked(0)));
  ASSERT_TRUE((*sink)->finish());
  const std::string text = bytes_of(folder / "hands.jsonl");
  EXPECT_NE(text.find(R"({"id":1,"skeleton":"body_hands","pinch":{"left":null,"right":{"distance_m":0.0300,"sigma_m":0.0102}},)"
                      R"("joints":{"pelvis":)"),
            std::string::npos);
  EXPECT_NE(text.find(R"("right_thumb_tip":{"p_in_rig_m":[0.1000,0.0000,2.0000])"), std::string::npos);
}

TEST(JsonLines, NothingIsCalledMetresWhereNothingIsMetric) {
  const test::TempFolder folder;
  TrackHeader header = clip_header({64, 48});
  header.metric = false;
  auto sink = make_json_lines(folder / "arm.jsonl", header);
  ASSERT_TRUE(sink && (*sink)->finish());
  EXPECT_NE(bytes_of(folder / "arm.jsonl").find(R"("units":{"length":"unknown",)"), std::string::npos);
}

TEST(JsonLines, AbandonedLeavesNothing) {
  const test::TempFolder folder;
  const Moment moment({64, 48});
  {
    auto sink = make_json_lines(folder / "arm.jsonl", clip_header({64, 48}));
    ASSERT_TRUE(sink);
    ASSERT_TRUE((*sink)->write(moment.tracked(0)));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder / ""));
  const auto nowhere = make_json_lines(folder / "none" / "arm.jsonl", clip_header({64, 48}));
  ASSERT_FALSE(nowhere);
  EXPECT_NE(nowhere.error().what.find("make the folder first"), std::string::npos) << nowhere.error().what;
}

/// Each colour fills a picture; the reader must find them again, to within what 4:2:0 and the encoder change.
TEST(VideoWriter, WhatWasWrittenIsRead) {
  const test::TempFolder folder;
  constexpr Size kSize = {96, 64};
  const Rgb8 colors[] = {{200, 30, 40}, {30, 180, 60}, {40, 60, 210}, {240, 240, 240}, {5, 5, 5}};
  for (const char* name : {"v.mp4", "again.mp4"}) {
    auto video = VideoWriter::open(folder / name, kSize, 1.0 / 25);
    ASSERT_TRUE(video) << video.error().what;
    for (const Rgb8& color : colors) {
      Image<Rgb8> picture(kSize);
      for (int y = 0; y < kSize.height; ++y) std::fill_n(picture.row(y), kSize.width, color);
      ASSERT_TRUE(video->write(picture));
    }
    EXPECT_FALSE(std::filesystem::exists(folder / name));
    ASSERT_TRUE(video->finish());
  }
  EXPECT_EQ(bytes_of(folder / "v.mp4"), bytes_of(folder / "again.mp4"));

  const auto source = open_source(folder / "v.mp4");
  ASSERT_TRUE(source) << source.error().what;
  EXPECT_EQ((*source)->size(), kSize);
  EXPECT_EQ((*source)->count(), 5);
  Picture picture;
  for (const Rgb8& want : colors) {
    const auto next = (*source)->next(picture);
    ASSERT_TRUE(next && *next == Next::kNew);
    EXPECT_EQ(picture.t_ns / 1'000'000, 40 * static_cast<std::int64_t>(picture.sequence));
    const Rgb8 got = picture.pixels.at(31, 47);
    EXPECT_NEAR(got.r, want.r, 6);
    EXPECT_NEAR(got.g, want.g, 6);
    EXPECT_NEAR(got.b, want.b, 6);
  }
  const auto end = (*source)->next(picture);
  EXPECT_TRUE(end && *end == Next::kEnd);
}

TEST(VideoWriter, FailuresLeaveNothing) {
  const test::TempFolder folder;
  EXPECT_FALSE(VideoWriter::open(folder / "none" / "v.mp4", {64, 48}, 0.04));
  EXPECT_FALSE(VideoWriter::open(folder / "", {64, 48}, 0.04));
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{2000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);  // stands for the full disk
  {
    auto video = VideoWriter::open(folder / "v.mp4", {320, 240}, 0.04);
    bool failed = !video;
    Image<Rgb8> noise({320, 240});
    std::srand(1);
    for (int t = 0; t < 3 && !failed; ++t) {
      for (int y = 0; y < 240; ++y)
        for (int x = 0; x < 320; ++x) noise.at(y, x).g = static_cast<std::uint8_t>(std::rand());
      failed = !video->write(noise);
    }
    if (!failed) failed = !video->finish();
    EXPECT_TRUE(failed);
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_TRUE(std::filesystem::is_empty(folder / ""));
}

}  // namespace
}  // namespace duo
