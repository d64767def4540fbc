// Sinks that take frame after frame: their bytes by hand, and what is on the disk before, after and instead of the end.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>

#include "duoptic/sink.h"
#include "duoptic/source.h"
#include "sinks/panels.h"
#include "sinks/video_writer.h"
#include "tests/write_media.h"

namespace duo {
namespace {

using test::bytes_of;

TrackHeader clip_header(Size size) {
  TrackHeader r;
  r.sources = {"left.avi", "odd \"name\"\xFF.avi"};
  r.engine = "simd";
  r.matcher = "pyramid";
  r.matcher_preset = "default";
  r.tracker = "arm";
  r.tracker_preset = "thesis";
  r.rectified = {size, 500, size.width / 2.0, size.height / 2.0, 0.125, {}, {}};
  r.size = size;
  return r;
}

/// A frame with everything the sinks look at: a wall at 2 m, gray, and an arm.
struct Moment {
  explicit Moment(Size size) {
    left.pixels = Image<Rgb8>(size);
    frame.color = Image<Rgb8>(size);
    frame.disparity.d_q4 = Image<std::uint16_t>(size);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        left.pixels.at(y, x) = {40, 80, 200};
        frame.color.at(y, x) = {200, 40, 40};
        frame.disparity.d_q4.at(y, x) = 500;  // 500 px * 0.125 m / 2 m = 31.25 px
      }
    arms.resize(1);
    arms[0][Joint::kHand] = {{0.1, -0.25, 1.5}, 0.0125, 0.9, 30, 20.5, JointState::kSeen};
    arms[0][Joint::kElbow] = {{-0.00001, 0, 2}, 0.25, 0.25, 12.345, 24, JointState::kInferred};
    arms[0][Joint::kShoulder] = {{9, 9, 9}, 1.5, 0, 9, 9, JointState::kLost};
  }
  TrackedFrame tracked(std::int64_t number) const { return {number, static_cast<double>(number) / 30, left, frame, arms, {}}; }

  Picture left;
  Frame frame;
  std::vector<ArmPose> arms;
};

constexpr char kHeader[] =
    R"({"type":"header","version":1,"units":{"length":"m","time":"s","uv":"px of the raw left picture"},)"
    R"("rig_from_left":[1.000000000,0.000000000,0.000000000,0.000000000,1.000000000,0.000000000,0.000000000,0.000000000,)"
    R"(1.000000000],"focal_px":500.0000,"baseline_m":0.125000,"sources":["left.avi","odd \"name\"�.avi"],"engine":"simd","device":null,)"
    R"("matcher":"pyramid","matcher_preset":"default","tracker":"arm","tracker_preset":"thesis","width":64,"height":48,)"
    R"("frame_s":0.033333})"
    "\n";
constexpr char kJoints[] =
    R"({"hand":{"p_in_rig_m":[0.1000,-0.2500,1.5000],"uv_left_px":[30.00,20.50],"state":"seen","confidence":0.900,)"
    R"("sigma_m":0.0125},"elbow":{"p_in_rig_m":[0.0000,0.0000,2.0000],"uv_left_px":[12.35,24.00],"state":"inferred",)"
    R"("confidence":0.250,"sigma_m":0.2500},"shoulder":{"p_in_rig_m":null,"uv_left_px":null,"state":"lost",)"
    R"("confidence":0.000,"sigma_m":1.5000}})";

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
  const std::string joints = kJoints;
  EXPECT_EQ(bytes_of(folder / "arm.jsonl"), kHeader +
                                                (R"({"type":"frame","frame":57,"t_s":1.900000,"joints":)" + joints + "}\n") +
                                                (R"({"type":"frame","frame":58,"t_s":1.933333,"joints":)" + joints +
                                                 R"(,"engine_ms":12.346,"tracker_ms":1.000})" + "\n"));
}

TEST(JsonLines, SecondArmAndNoArm) {
  const test::TempFolder folder;
  Moment moment({64, 48});
  auto sink = make_json_lines(folder / "arm.jsonl", clip_header({64, 48}));
  ASSERT_TRUE(sink);
  moment.arms.push_back(moment.arms[0]);
  ASSERT_TRUE((*sink)->write(moment.tracked(0)));
  moment.arms.clear();
  ASSERT_TRUE((*sink)->write(moment.tracked(1)));
  ASSERT_TRUE((*sink)->finish());
  const std::string joints = kJoints;
  EXPECT_EQ(bytes_of(folder / "arm.jsonl"),
            kHeader + (R"({"type":"frame","frame":0,"t_s":0.000000,"joints":)" + joints + R"(,"joints2":)" + joints + "}\n") +
                R"({"type":"frame","frame":1,"t_s":0.033333})" + "\n");
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
    ASSERT_TRUE(next && *next == Next::kPicture);
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

TEST(Panels, JointsAndBonesWhereTheyAre) {
  constexpr Size kSize = {320, 240};
  Moment moment(kSize);
  const TrackHeader header = clip_header(kSize);
  moment.arms[0][Joint::kHand] = {{0, 0, 2}, 0.01, 1, 80, 120, JointState::kSeen};
  moment.arms[0][Joint::kElbow] = {{0.2, 0, 2}, 0.01, 1, 240, 120, JointState::kSeen};
  const auto draw = [&] { return draw_panels(moment.tracked(3), header, {10, 60}); };
  const Image<Rgb8> seen = draw();
  EXPECT_EQ(seen.size(), panels_size(header));
  EXPECT_EQ(seen.width() % 2 + seen.height() % 2, 0);
  const int top = 14;  // the title of a picture half as wide as the widest
  const auto count = [&](const Image<Rgb8>& picture, auto&& like) {
    int n = 0;
    for (int x = 100; x < 220; ++x) n += like(picture.at(top + 120, x));
    return n;
  };
  const auto red = [](Rgb8 c) { return c.r > 180 && c.g < 90 && c.b < 90; };
  EXPECT_EQ(count(seen, red), 120);                        // the whole bone
  EXPECT_EQ(seen.at(top + 60, 160), (Rgb8{40, 80, 200}));  // the picture itself
  const Rgb8 joint = seen.at(top + 120, 80);
  EXPECT_GT(joint.g, 180);
  EXPECT_LT(joint.r, 100);

  moment.arms[0][Joint::kElbow].state = JointState::kInferred;
  const int broken = count(draw(), red);
  EXPECT_GT(broken, 40);
  EXPECT_LT(broken, 80);
  moment.arms[0][Joint::kElbow].state = JointState::kLost;
  EXPECT_EQ(count(draw(), red), 0);
}

TEST(Panels, RegionInTheShadeOfTheNearestJoint) {
  constexpr Size kSize = {320, 240};
  Moment moment(kSize);
  const TrackHeader header = clip_header(kSize);
  // The wall at 2 m: x_m = (x - 160) / 250. Hand at the centre, elbow 0.3 m to its right, shoulder lost.
  moment.arms[0][Joint::kHand] = {{0, 0, 2}, 0.01, 1, 0, 0, JointState::kSeen};
  moment.arms[0][Joint::kElbow] = {{0.3, 0, 2}, 0.01, 1, 0, 0, JointState::kSeen};
  Image<Rgb8> drawn(kSize);
  draw_arm_region(moment.frame, header.rectified, moment.arms, drawn);
  const Rgb8 hand = drawn.at(120, 165), elbow = drawn.at(120, 230), wall = drawn.at(30, 165);
  EXPECT_EQ(drawn.at(120, 190), hand);   // 0.12 m along
  EXPECT_EQ(drawn.at(120, 205), elbow);  // 0.18 m
  EXPECT_EQ(drawn.at(120, 260), wall);   // 0.1 m past the elbow
  EXPECT_GT(hand.g, elbow.g);
  EXPECT_GT(elbow.g, wall.g);
  EXPECT_EQ(wall.r, wall.g);
}

TEST(Panels, HueByHand) {
  EXPECT_EQ(color_of_hue(0), (Rgb8{255, 0, 0}));
  EXPECT_EQ(color_of_hue(85), (Rgb8{0, 255, 0}));
  EXPECT_EQ(color_of_hue(171), (Rgb8{0, 0, 255}));
  Image<Rgb8> src({3, 1}), dst({3, 1});
  src.at(0, 0) = {90, 0, 0};       // saturated, however dark
  src.at(0, 1) = {77, 77, 77};     // gray
  src.at(0, 2) = {200, 150, 150};  // saturation 1/4: half as bright
  draw_hue(src, dst);
  EXPECT_EQ(dst.at(0, 0), (Rgb8{255, 0, 0}));
  EXPECT_EQ(dst.at(0, 1), (Rgb8{0, 0, 0}));
  EXPECT_NEAR(dst.at(0, 2).r, 127, 1);
  EXPECT_EQ(dst.at(0, 2).g, 0);
}

TEST(Panels, WhateverTheSizes) {
  for (const Size raw : {Size{1, 1}, Size{3, 5}, Size{161, 90}, Size{1280, 720}, Size{720, 1280}})
    for (const Size map : {Size{1, 1}, Size{40, 90}, Size{700, 500}}) {
      Moment moment(map);
      TrackHeader header = clip_header(map);
      header.size = raw;
      moment.left.pixels = Image<Rgb8>(raw);
      EXPECT_EQ(draw_panels(moment.tracked(0), header, {}).size(), panels_size(header));
      EXPECT_EQ(panels_size(header).width % 2, 0);
      EXPECT_EQ(panels_size(header).height % 2, 0);
    }
}

}  // namespace
}  // namespace duo
