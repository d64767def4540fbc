// `duoptic record` and `play` as their users meet them, and `track` on what they wrote.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "duoptic/pipeline.h"
#include "duoptic/rig.h"
#include "duoptic/source.h"
#include "duoptic/synthetic.h"
#include "sinks/clip/avi.h"
#include "sinks/video_writer.h"
#include "tool.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::Ended;
using test::put;

using test::kCut;
using test::kInput;
using test::kOutput;
using test::kUsage;

/// The synthetic room as two AVIs of JPEGs and as two MP4s, each also as a recording.
class Record : public ::testing::Test {
 protected:
  static constexpr int kPairs = 4;
  static constexpr char kSelect[] = " --matcher pyramid --select hand=160,100 --select elbow=160,77 --select shoulder=160,54 ";

  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TempFolder>();
    const SyntheticSetup setup{.size = {320, 240}};
    const SyntheticPair raw = render_synthetic(setup, 2);
    for (const bool right : {false, true}) {
      const std::string side = right ? "right" : "left";
      auto avi = AviWriter::open(at(side + ".avi"), setup.size, 30, 90);
      auto mp4 = VideoWriter::open(at(side + ".mp4"), setup.size, 1.0 / 30);
      ASSERT_TRUE(avi && mp4);
      const Image<Rgb8>& pixels = (right ? raw.pair.right : raw.pair.left).pixels;
      for (int i = 0; i < kPairs; ++i) ASSERT_TRUE(avi->write(pixels) && mp4->write(pixels));
      ASSERT_TRUE(avi->finish() && mp4->finish());
    }
    ASSERT_TRUE(save_rig(raw.rig, at("rig.json")));
    ASSERT_EQ(run("record left.avi right.avi --rig rig.json -o jpeg.mkv").exit, 0);
    ASSERT_EQ(run("record left.mp4 right.mp4 --rig rig.json -o raw.mkv --quiet").exit, 0);
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static fs::path at(const std::string& name) { return *folder_ / name; }
  static Ended run(const std::string& arguments, const std::string& before = "") {
    return test::run_tool(at(""), arguments, before);
  }
  /// A gst-launch-1.0 for the tool: black pictures at 50 a second for half a second, then nothing, and it does not end. Its two
  /// sources stay silent when they are opened again, however late that is.
  static std::string with_camera_that_falls_silent() {
    fs::remove(at("gst-launch-1.0.starts"));
    put(at("gst-launch-1.0"),
        "#!/bin/sh\necho start >> \"$0.starts\"\n"
        "[ $(wc -l < \"$0.starts\") -le 2 ] || exec sleep 1000\n"
        "printf 'YUV4MPEG2 W16 H16 F50:1 Ip A1:1 C444\\n'\n"
        "for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do\n"
        "  printf 'FRAME\\n'; head -c 768 /dev/zero; sleep 0.02\ndone\nexec sleep 1000\n");
    fs::permissions(at("gst-launch-1.0"), fs::perms::owner_all);
    return "PATH='" + at("").string() + "':$PATH";
  }
  static void expect_failure(const std::string& arguments, int exit, const std::string& words, const std::string& before = "") {
    SCOPED_TRACE(arguments);
    const Ended ended = run(arguments, before);
    EXPECT_EQ(ended.exit, exit) << ended.err;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_NE(ended.err.find(words), std::string::npos) << ended.err;
    EXPECT_EQ(ended.out, "");
  }
  /// Without the header, which names the sources.
  static std::string lines(const std::string& text) { return text.substr(text.find('\n') + 1); }

 private:
  inline static std::unique_ptr<test::TempFolder> folder_;
};

TEST_F(Record, TrackGivesTheBytesThatItGaveOnTheSource) {
  for (const std::string kind : {"avi", "mp4"}) {
    const Ended source = run("track left." + kind + " right." + kind + " --rig rig.json" + kSelect);
    const Ended recording = run(std::string("track ") + (kind == "avi" ? "jpeg.mkv" : "raw.mkv") + kSelect);
    ASSERT_EQ(source.exit, 0) << source.err;
    ASSERT_EQ(recording.exit, 0) << recording.err;
    EXPECT_EQ(lines(recording.out), lines(source.out));
    EXPECT_EQ(std::count(source.out.begin(), source.out.end(), '\n'), 1 + kPairs);
    auto a = nlohmann::json::parse(source.out.substr(0, source.out.find('\n')), nullptr, false),
         b = nlohmann::json::parse(recording.out.substr(0, recording.out.find('\n')), nullptr, false);
    a.erase("sources");
    b.erase("sources");
    EXPECT_EQ(a, b);
  }
}

TEST_F(Record, EveryCommandTakesARecordingWithItsRig) {
  const Ended depth = run("depth jpeg.mkv --matcher pyramid --every 3 --near 1 -o depth_out --quiet");
  EXPECT_EQ(depth.exit, 0) << depth.err;
  EXPECT_TRUE(fs::exists(at("depth_out/frame_000003/cloud.ply")));  // its rig is known
  const Ended again = run("record jpeg.mkv -o again.mkv --json");
  EXPECT_EQ(again.json()["rig"], true);
  EXPECT_EQ(again.json()["codecs"], "MJPEG, MJPEG");
  EXPECT_EQ(bytes_of(at("again.mkv")), bytes_of(at("jpeg.mkv")));
}

TEST_F(Record, PlayTellsAndExports) {
  const Ended played = run("play jpeg.mkv --json --export parts");
  ASSERT_EQ(played.exit, 0) << played.err;
  const auto report = played.json();
  EXPECT_EQ(report["pairs"], kPairs);
  EXPECT_EQ(report["left"]["codec"], "mjpeg");
  EXPECT_NEAR(report["rate_hz"], 30, 1e-3);
  EXPECT_EQ(report["cut"], false);
  EXPECT_EQ(report["files"].size(), 4u);
  EXPECT_EQ(bytes_of(at("parts/rig.json")), bytes_of(at("rig.json")));
  const Ended back = run("record parts/left.avi parts/right.avi --rig parts/rig.json -o back.mkv");
  EXPECT_EQ(back.exit, 0) << back.err;
  EXPECT_EQ(bytes_of(at("back.mkv")), bytes_of(at("jpeg.mkv")));
  EXPECT_NE(run("play raw.mkv").out.find("left ffv1, right ffv1, 320x240"), std::string::npos);
  expect_failure("play left.avi", kInput, "it is no recording");
  expect_failure("play none.mkv", kInput, "no such file");
}

TEST_F(Record, CutRecordingGivesItsWholePairs) {
  const std::string whole = bytes_of(at("jpeg.mkv"));
  put(at("cut.mkv"), std::string_view(whole).substr(0, whole.size() / 2));
  const Ended tracked = run("track cut.mkv -o cut.jsonl --quiet" + std::string(kSelect));
  EXPECT_EQ(tracked.exit, kCut) << tracked.err;
  EXPECT_NE(tracked.err.find("cut.mkv is cut short"), std::string::npos) << tracked.err;
  EXPECT_EQ(run("play cut.mkv").exit, kCut);
  put(at("head.mkv"), std::string_view(whole).substr(0, 900));
  expect_failure("track head.mkv" + std::string(kSelect), kInput, "head.mkv");
}

TEST_F(Record, SecondsAndNames) {
  const Ended ended = run("record left.avi right.avi -o part.mkv --seconds 0.09 --json");
  EXPECT_EQ(ended.json()["pairs"], 3) << ended.err;
  expect_failure("track part.mkv" + std::string(kSelect), kUsage, "--rig");
  expect_failure("record left.avi right.avi -o part.mkv", kOutput, "choose another name");
  EXPECT_EQ(run("record left.avi right.avi -o part.mkv --force").exit, 0);
  expect_failure("record left.avi right.avi -o none/a.mkv", kOutput, "make the folder first");
  expect_failure("record left.avi none.avi -o never.mkv", kInput, "none.avi");
  ASSERT_TRUE(save_rig(synthetic_rig({.size = {640, 480}}), at("other.json")));
  expect_failure("record left.avi right.avi --rig other.json -o never.mkv", kInput, "640x480");
  EXPECT_FALSE(fs::exists(at("never.mkv")));
}

TEST_F(Record, FullDiskKeepsWhatWasRecorded) {
  const auto blocks = fs::file_size(at("raw.mkv")) / 512 * 2 / 3;
  expect_failure("record left.mp4 right.mp4 -o full.mkv", kOutput, "pairs, is in it",
                 "ulimit -f " + std::to_string(blocks) + ";");
  const Ended played = run("play full.mkv --json");
  EXPECT_EQ(played.exit, 0) << played.err;
  EXPECT_GE(played.json()["pairs"], 2);
  expect_failure("record left.mp4 right.mp4 -o empty.mkv", kOutput, "empty.mkv", "ulimit -f 4;");
  EXPECT_FALSE(fs::exists(at("empty.mkv")));
}

TEST_F(Record, TrackRecordsWhatItTracks) {
  const std::string track = std::string(kSelect) + "--rig rig.json ";
  const Ended tracked = run("track left.avi right.avi --record way.mkv" + track);
  EXPECT_EQ(tracked.exit, 0) << tracked.err;
  EXPECT_EQ(test::bytes_of(at("way.mkv")), test::bytes_of(at("jpeg.mkv")));
  expect_failure("track left.avi right.avi --record way.mkv" + track, kOutput, "choose another name");
  EXPECT_EQ(run("track left.avi right.avi --record way.mkv --force" + track).exit, 0);

  // The disk is full, and tracking goes on to the end.
  const auto blocks = fs::file_size(at("raw.mkv")) / 512 * 2 / 3;
  const Ended full = run("track left.mp4 right.mp4 --record short.mkv" + track, "ulimit -f " + std::to_string(blocks) + ";");
  EXPECT_EQ(full.exit, kOutput) << full.err;
  EXPECT_NE(full.err.find("tracking goes on"), std::string::npos) << full.err;
  EXPECT_EQ(std::count(full.out.begin(), full.out.end(), '\n'), 1 + kPairs);
  EXPECT_GE(run("play short.mkv --json").json()["pairs"], 2);
}

TEST_F(Record, SeveralSinksAtOnceOrNone) {
  const std::string track = "track jpeg.mkv" + std::string(kSelect);
  const Ended all = run(track +
                        "-o a.jsonl --csv a.csv --csv b.csv --bvh a.bvh --osc 127.0.0.1:9 --vmc 127.0.0.1:9 --vmc localhost:9 "
                        "--axes unity --arm left --quiet");
  EXPECT_EQ(all.exit, 0) << all.err;
  const std::string table = bytes_of(at("a.csv"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + 3 * kPairs);
  EXPECT_EQ(table, bytes_of(at("b.csv")));
  EXPECT_NE(bytes_of(at("a.bvh")).find("ROOT LeftArm"), std::string::npos);
  expect_failure(track + "-o c.jsonl --csv c.csv --osc nowhere", kInput, "HOST:PORT");
  expect_failure(track + "-o c.jsonl --csv c.csv --bvh none/a.bvh", kOutput, "make the folder first");
  expect_failure(track + "--axes maya", kUsage, "maya");
  EXPECT_FALSE(fs::exists(at("c.csv")) || fs::exists(at("c.jsonl")));
}

/// As live, with a thread for each sink that could wait.
TEST_F(Record, RealTimeTakesNewestFirst) {
  const Ended ended =
      run("track jpeg.mkv --realtime --stats -o live.jsonl --csv live.csv --video live.mp4" + std::string(kSelect));
  ASSERT_EQ(ended.exit, 0) << ended.err;
  const std::string text = bytes_of(at("live.jsonl"));
  EXPECT_GE(std::count(text.begin(), text.end(), '\n'), 2);
  EXPECT_NE(ended.err.find("frames/s"), std::string::npos) << ended.err;
}

// The right pictures are taken 12 ms late and the person moves: `depth` writes the disparities that `track` looks at, which are
// not those of the pairs as they come.
TEST(RecordWithSkew, DepthAndTrackHaveTheSameDisparities) {
  constexpr int kPairs = 4;
  const test::TempFolder folder;
  auto clip = SyntheticClip::open({.size = {160, 120}, .script = "wave", .frames = 40, .skew_s = 0.012}, 2);
  ASSERT_TRUE(clip) << clip.error().what;
  auto left = AviWriter::open(folder / "left.avi", {160, 120}, 30, 90),
       right = AviWriter::open(folder / "right.avi", {160, 120}, 30, 90);
  ASSERT_TRUE(left && right);
  for (int i = 0; i < kPairs; ++i) {
    const Pair pair = clip->frame(17 + i).pair;
    ASSERT_TRUE(left->write(pair.left.pixels) && right->write(pair.right.pixels));
  }
  ASSERT_TRUE(left->finish() && right->finish() && save_rig(clip->rig(), folder / "rig.json"));
  const auto run = [&](const std::string& arguments) { return test::run_tool(folder / "", arguments); };
  ASSERT_EQ(run("record left.avi right.avi --rig rig.json --skew-ms 12 -o late.mkv").exit, 0);
  const Ended depth = run("depth late.mkv --matcher pyramid --max-disparity 32 -o out");
  ASSERT_EQ(depth.exit, 0) << depth.err;

  const auto frames_of = [&](bool late) {  // as track has them
    PipelineSetup setup;
    setup.tracker = "arm";
    setup.frames.matcher = "pyramid";
    setup.frames.max_disparity = 32;
    setup.frames.many_at_once = true;
    setup.frames.rig = clip->rig();
    auto pairs = late ? open_pairs(folder / "late.mkv", "") : open_pairs(folder / "left.avi", folder / "right.avi");
    EXPECT_TRUE(pairs);
    auto pipeline = Pipeline::open(std::move(*pairs), setup);
    EXPECT_TRUE(pipeline);
    std::vector<std::shared_ptr<const Frame>> frames;
    while (*pipeline->next() == Next::kNew) frames.push_back(pipeline->frame());
    return frames;
  };
  const auto tracked = frames_of(true), as_they_came = frames_of(false);
  ASSERT_EQ(tracked.size(), std::size_t{kPairs});
  ASSERT_EQ(as_they_came.size(), std::size_t{kPairs});
  int differ = 0, moved = 0;
  for (std::size_t i = 0; i < tracked.size(); ++i) {
    const auto written = read_pfm(folder / ("out/frame_00000" + std::to_string(i)) / "disparity.pfm");
    ASSERT_TRUE(written) << written.error().what;
    for (int y = 0; y < written->height(); ++y)
      for (int x = 0; x < written->width(); ++x) {
        const std::uint16_t want = tracked[i]->disparity.d_q4.at(y, x);
        differ += want == Disparity::kNone ? !std::isinf(written->at(y, x)) : written->at(y, x) != want / 16.0f;
        moved += want != as_they_came[i]->disparity.d_q4.at(y, x);
      }
  }
  EXPECT_EQ(differ, 0);
  EXPECT_GT(moved, 20);
}

/// Pictures that do not come any more keep no recording open, and are said to be away.
TEST_F(Record, SecondsEndByTheClock) {
  const Ended ended = run("record gst:a gst:b -o silent.mkv --seconds 3.5 --json", with_camera_that_falls_silent());
  ASSERT_EQ(ended.exit, 0) << ended.err;
  EXPECT_NE(ended.err.find("gst:a is away: it gives no pictures"), std::string::npos) << ended.err;
  EXPECT_GT(ended.json().value("pairs", 0), 0);
  EXPECT_LT(ended.json().value("length_s", 9.0), 2);
}

}  // namespace
}  // namespace duo
