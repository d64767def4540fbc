// A written clip is what the renderer gave, and appears whole or not at all.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "duoptic/sink.h"
#include "duoptic/source.h"
#include "duoptic/synthetic.h"
#include "tests/write_media.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
SyntheticClipSetup setup_of(int frames) { return {.size = {64, 48}, .seed = 2, .script = "wave", .frames = frames}; }
const std::function<bool(int, int)> kSilent;

TEST(WriteClip, ReadsBackAsItWasRendered) {
  const test::TempFolder temp;
  int told = 0;
  const auto written = write_clip(setup_of(12), temp / "clip", 2, [&](int done, int frames) {
    EXPECT_EQ(done, ++told);
    EXPECT_EQ(frames, 12);
    return true;
  });
  ASSERT_TRUE(written.has_value()) << written.error().what;
  EXPECT_EQ(told, 12);
  auto clip = SyntheticClip::open(setup_of(12), 2);
  ASSERT_TRUE(clip.has_value());

  const auto rig = load_rig(temp / "clip/calibration_truth.yml");
  ASSERT_TRUE(rig.has_value()) << rig.error().what;
  EXPECT_EQ(rig->left, clip->rig().left);
  EXPECT_EQ(rig->right, clip->rig().right);
  EXPECT_EQ(rig->right_from_left, clip->rig().right_from_left);

  auto pairs = open_pairs(temp / "clip/left.avi", temp / "clip/right.avi");
  ASSERT_TRUE(pairs.has_value()) << pairs.error().what;
  Pair pair;
  for (int i = 0; i < 12; ++i) {
    const auto next = (*pairs)->next(pair);
    ASSERT_TRUE(next.has_value() && *next == Next::kNew) << i;
    const SyntheticClipFrame frame = clip->frame(i);
    double off = 0;
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 64; ++x) off += std::abs(pair.left.pixels.at(y, x).g - frame.pair.left.pixels.at(y, x).g);
    EXPECT_LT(off / (64 * 48), 8) << i;  // JPEG
  }
  EXPECT_EQ(*(*pairs)->next(pair), Next::kEnd);
  EXPECT_EQ((*pairs)->warning(), "");

  const auto truth = nlohmann::json::parse(test::bytes_of(temp / "clip/truth.json"));
  EXPECT_EQ(truth["meta"]["clip"], "clip");
  EXPECT_EQ(truth["meta"]["selected_arm"], "left");
  ASSERT_EQ(truth["frames"].size(), 12U);
  const SyntheticClipFrame frame = clip->frame(7);
  for (const SyntheticJoint& joint : frame.joints) {
    const auto& got = truth["frames"][7]["joints"][std::string(name_of(joint.id))];
    EXPECT_NEAR(got["xyz"][2].get<double>(), joint.p_in_left_m.z, 1e-5);
    EXPECT_EQ(got["vis_left"], joint.visible_left);
    EXPECT_EQ(got["uv_left"].is_null(), !joint.uv_left_px.has_value());
  }
}

TEST(WriteClip, DepthIsThatOfAPinhole) {
  const test::TempFolder temp;
  ASSERT_TRUE(write_clip(setup_of(11), temp / "clip", 2, kSilent).has_value());
  EXPECT_FALSE(fs::exists(temp / "clip/depth/depth_0001.png"));
  auto clip = SyntheticClip::open(setup_of(11), 2);
  const SyntheticClip::Pinhole want = clip->pinhole(10);
  const auto depth = read_png16(temp / "clip/depth/depth_0010.png"), mask = read_png16(temp / "clip/depth/figure_0010.png");
  ASSERT_TRUE(depth.has_value() && mask.has_value());
  int person = 0;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) {
      ASSERT_NEAR(depth->at(y, x) / 1e4, want.depth_m.at(y, x), 5.1e-5);
      ASSERT_EQ(mask->at(y, x) != 0, want.figure.at(y, x) != 0);
      person += mask->at(y, x) != 0;
    }
  EXPECT_GT(person, 200);
  EXPECT_LT(person, 1500);
}

TEST(WriteClip, ALateRightCamera) {
  const test::TempFolder temp;
  SyntheticClipSetup setup = setup_of(2);
  ASSERT_TRUE(write_clip(setup, temp / "clip", 2, kSilent).has_value());
  setup.skew_s = 0.016;
  ASSERT_TRUE(write_clip(setup, temp / "late", 2, kSilent).has_value());
  EXPECT_EQ(test::bytes_of(temp / "clip/left.avi"), test::bytes_of(temp / "late/left.avi"));
  EXPECT_NE(test::bytes_of(temp / "clip/right.avi"), test::bytes_of(temp / "late/right.avi"));
  EXPECT_EQ(nlohmann::json::parse(test::bytes_of(temp / "clip/truth.json"))["meta"]["skew_ms"], 0.0);
  EXPECT_EQ(nlohmann::json::parse(test::bytes_of(temp / "late/truth.json"))["meta"]["skew_ms"], 16.0);
  setup.skew_s = 0.2;
  EXPECT_FALSE(write_clip(setup, temp / "later", 2, kSilent).has_value());
}

TEST(WriteClip, AppearsWholeOrNotAtAll) {
  const test::TempFolder temp;
  const auto entries = [&] { return std::distance(fs::directory_iterator(temp / ""), fs::directory_iterator()); };
  // Not a clip: left alone.
  fs::create_directory(temp / "mine");
  test::put(temp / "mine/notes.txt", "precious");
  const auto taken = write_clip(setup_of(1), temp / "mine", 1, kSilent);
  ASSERT_FALSE(taken.has_value());
  EXPECT_EQ(taken.error().code, ErrorCode::kWriteFailed);
  EXPECT_EQ(test::bytes_of(temp / "mine/notes.txt"), "precious");
  // Nor is a clip with something of the user's beside it.
  ASSERT_TRUE(write_clip(setup_of(1), temp / "noted", 1, kSilent).has_value());
  test::put(temp / "noted/notes.txt", "precious");
  EXPECT_FALSE(write_clip(setup_of(1), temp / "noted", 1, kSilent).has_value());
  EXPECT_EQ(test::bytes_of(temp / "noted/notes.txt"), "precious");
  fs::remove_all(temp / "noted");
  // A setup that cannot be leaves nothing behind.
  EXPECT_FALSE(write_clip({.script = "dance"}, temp / "dance", 1, kSilent).has_value());
  EXPECT_EQ(entries(), 1);
  // No folder can be made below a file.
  EXPECT_FALSE(write_clip(setup_of(1), temp / "mine/notes.txt/clip", 1, kSilent).has_value());
  // An earlier clip is replaced, and while the new one is made it is there.
  ASSERT_TRUE(write_clip(setup_of(2), temp / "clip", 1, kSilent).has_value());
  const std::string earlier = test::bytes_of(temp / "clip/truth.json");
  ASSERT_TRUE(write_clip(setup_of(1), temp / "clip/", 1, [&](int, int) {
                EXPECT_EQ(test::bytes_of(temp / "clip/truth.json"), earlier);
                return true;
              }).has_value());
  EXPECT_NE(test::bytes_of(temp / "clip/truth.json"), earlier);
  EXPECT_EQ(entries(), 2);
}

TEST(WriteClip, OneThatIsEndedEarlyIsAWholeClipOfFewerFrames) {
  const test::TempFolder temp;
  ASSERT_TRUE(write_clip(setup_of(9), temp / "clip", 1, [](int done, int) { return done < 3; }).has_value());
  const auto truth = nlohmann::json::parse(test::bytes_of(temp / "clip/truth.json"));
  EXPECT_EQ(truth["frames"].size(), 3U);
  auto pairs = open_pairs(temp / "clip/left.avi", temp / "clip/right.avi");
  ASSERT_TRUE(pairs.has_value());
  Pair pair;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(*(*pairs)->next(pair), Next::kNew);
  EXPECT_EQ(*(*pairs)->next(pair), Next::kEnd);
}

}  // namespace
}  // namespace duo
