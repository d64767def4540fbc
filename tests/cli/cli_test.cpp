// The tool as its users meet it: good runs leave the files they promise; bad input gives one clear line, the promised exit
// code, and nothing under the final names.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "duoptic/rig.h"
#include "duoptic/sink.h"
#include "duoptic/source.h"
#include "duoptic/synthetic.h"
#include "tests/data.h"
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

/// A small synthetic pair with its rig, and the tool run beside it.
class Cli : public ::testing::Test {
 protected:
  void SetUp() override {
    static const SyntheticPair raw = render_synthetic({.size = {160, 120}}, 2);
    ASSERT_TRUE(write_png(raw.pair.left.pixels, at("left.png")));
    ASSERT_TRUE(write_png(raw.pair.right.pixels, at("right.png")));
    ASSERT_TRUE(save_rig(raw.rig, at("rig.json")));
  }

  fs::path at(const std::string& name) const { return folder_ / name; }

  /// Runs the tool in the folder of its inputs; `before` is shell, for limits.
  Ended run(const std::string& arguments, const std::string& before = "") const {
    return test::run_tool(at(""), arguments, before);
  }

  /// Every bad call: one line, its exit code, its words, no output.
  void expect_failure(const std::string& arguments, int exit, const std::string& words, const std::string& before = "") const {
    SCOPED_TRACE(arguments);
    const Ended ended = run(arguments, before);
    EXPECT_EQ(ended.exit, exit) << ended.err;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_EQ(ended.err.rfind("duoptic", 0), 0u) << ended.err;
    EXPECT_NE(ended.err.find(words), std::string::npos) << ended.err;
    EXPECT_EQ(ended.out, "");
    EXPECT_FALSE(fs::exists(at("out")));
  }

  void write_rig(const std::string& name, const std::function<void(Rig&)>& spoil) const {
    Rig rig = synthetic_rig({.size = {160, 120}});
    spoil(rig);
    ASSERT_TRUE(save_rig(rig, at(name)));
  }

 private:
  test::TempFolder folder_;
};

TEST_F(Cli, RectifiedPairLeavesDisparity) {
  const Ended ended = run("depth left.png right.png --max-disparity 32 -o out");
  ASSERT_EQ(ended.exit, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  const auto pfm = read_pfm(at("out/disparity.pfm"));
  ASSERT_TRUE(pfm);
  EXPECT_EQ(pfm->size(), (Size{160, 120}));
  EXPECT_TRUE(open_source(at("out/disparity.png")));
  EXPECT_FALSE(fs::exists(at("out/depth.png")));  // metres need a rig
  EXPECT_EQ(std::distance(fs::directory_iterator(at("out")), fs::directory_iterator()), 2);
}

TEST_F(Cli, RowsThatDisagreeArePutRight) {
  const auto depth = [&](const char* more) {
    const Ended ended = run(std::string("depth left.png right.png --max-disparity 32 -o out --json ") + more);
    EXPECT_EQ(ended.exit, 0) << ended.err;
    return nlohmann::json::parse(ended.out, nullptr, false);
  };
  const auto right = depth(""), kept = depth("--keep-rows"), with_rig = depth("--rig rig.json");
  ASSERT_TRUE(right["rows"].is_object()) << "raw pictures, as if they were rectified";
  EXPECT_GT(right["rows"]["median_before_px"], 1.0);
  EXPECT_LT(right["rows"]["median_after_px"], 0.3);
  EXPECT_TRUE(kept["rows"].is_null());
  EXPECT_TRUE(with_rig["rows"].is_null());
  EXPECT_GT(right["coverage_percent"].get<double>(), 1.2 * kept["coverage_percent"].get<double>());
  EXPECT_NE(run("depth left.png right.png --max-disparity 32 -o out").out.find("rows disagreed by"), std::string::npos);
}

TEST_F(Cli, RawPairWithRigLeavesDepthAndPoints) {
  const Ended ended = run("depth left.png right.png --rig rig.json --max-disparity 32 -o out/deep --json --threads 2");
  ASSERT_EQ(ended.exit, 0) << ended.err;
  const auto json = nlohmann::json::parse(ended.out, nullptr, false);
  ASSERT_TRUE(json.is_object()) << ended.out;
  EXPECT_EQ(json["frames"], 1);
  EXPECT_EQ(json["files"].size(), 6u);
  EXPECT_GT(json["coverage_percent"], 30.0);
  for (const char* name : {"disparity.pfm", "disparity.png", "depth.png", "left_rectified.png", "camera.json", "cloud.ply"})
    EXPECT_GT(fs::file_size(at("out/deep") / name), 500u) << name;
  EXPECT_EQ(bytes_of(at("out/deep/cloud.ply")).rfind("ply\n", 0), 0u);
}

TEST_F(Cli, EnginesAndThreadsAgreeToTheByte) {
  ASSERT_EQ(run("depth left.png right.png --rig rig.json --max-disparity 24 -o ref --engine ref").exit, 0);
  for (const char* threads : {"1", "2", "3"}) {
    ASSERT_EQ(run(std::string("depth left.png right.png --rig rig.json --max-disparity 24 -o simd --engine simd --threads ") +
                  threads)
                  .exit,
              0);
    EXPECT_EQ(bytes_of(at("ref/disparity.pfm")), bytes_of(at("simd/disparity.pfm")));
    EXPECT_EQ(bytes_of(at("ref/depth.png")), bytes_of(at("simd/depth.png")));
  }
}

TEST_F(Cli, AWindowHasTheWholePicturesDepthAndNothingAround) {
  const std::string both = "depth left.png right.png --rig rig.json --max-disparity 24 -o ";
  ASSERT_EQ(run(both + "whole").exit, 0);
  ASSERT_EQ(run(both + "part --window 60,40,30,20 --window 100,100,90,90").exit, 0);
  const auto whole = read_png16(at("whole/depth.png")), part = read_png16(at("part/depth.png"));
  ASSERT_TRUE(whole && part);
  int known = 0;
  for (int y = 0; y < whole->height(); ++y)
    for (int x = 0; x < whole->width(); ++x) {
      const bool inside = (x >= 60 && x < 90 && y >= 40 && y < 60) || (x >= 100 && y >= 100);
      EXPECT_EQ(part->at(y, x), inside ? whole->at(y, x) : 0) << x << "," << y;
      known += part->at(y, x) != 0;
    }
  EXPECT_GT(known, 300);
}

TEST_F(Cli, VideosGiveAFolderAFrame) {
  test::write_video(at("v.avi"), AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P, 0);
  const Ended ended = run("depth v.avi v.avi --max-disparity 16 --every 5 -o out --quiet");
  ASSERT_EQ(ended.exit, 0) << ended.err;
  EXPECT_EQ(ended.out, "");
  EXPECT_EQ(ended.err, "duoptic depth: warning: left and right are the same picture; give one of each camera\n");
  for (const char* frame : {"frame_000000", "frame_000005", "frame_000010"})
    EXPECT_TRUE(fs::exists(at("out") / frame / "disparity.pfm"));
  EXPECT_EQ(std::distance(fs::directory_iterator(at("out")), fs::directory_iterator()), 3);
}

TEST_F(Cli, CutVideoGivesItsWholeFrames) {
  test::write_video(at("v.avi"), AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P, 0);
  const std::string whole = bytes_of(at("v.avi"));
  put(at("cut.avi"), std::string_view(whole).substr(0, whole.size() / 2));
  const Ended ended = run("depth cut.avi --layout side-by-side --max-disparity 16 -o out");
  EXPECT_EQ(ended.exit, kCut);
  EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  EXPECT_NE(ended.err.find("cut.avi is cut short"), std::string::npos) << ended.err;
  EXPECT_EQ(ended.err.find("damaged: left out"), std::string::npos) << ended.err;  // the last one is the cut itself
  const auto frames = std::distance(fs::directory_iterator(at("out")), fs::directory_iterator());
  EXPECT_GT(frames, 0);
  EXPECT_LT(frames, test::kFrames);
}

TEST_F(Cli, BadPictures) {
  put(at("empty.png"), "");
  put(at("text.png"), "these are only words, and no picture at all");
  put(at("cut.png"), std::string_view(bytes_of(at("left.png"))).substr(0, 5000));
  ASSERT_TRUE(write_png(Image<Rgb8>({80, 60}), at("small.png")));
  ASSERT_TRUE(write_png(Image<Rgb8>({81, 60}), at("odd.png")));
  test::write_video(at("v.avi"), AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P, 0);
  put(at("start.avi"), std::string_view(bytes_of(at("v.avi"))).substr(0, 300));
  expect_failure("depth missing.png right.png -o out", kInput, "missing.png: no such file");
  expect_failure("depth left.png empty.png -o out", kInput, "empty.png: the file is empty");
  expect_failure("depth text.png right.png -o out", kInput, "text.png: it is no picture or video");
  expect_failure("depth left.png cut.png -o out", kInput, "cut.png: it is cut short");
  expect_failure("depth left.png small.png -o out", kInput, "sizes differ, 160x120 and 80x60");
  expect_failure("depth odd.png -o out", kInput, "even width");
  expect_failure("depth left.png v.avi -o out", kInput, "one is a picture, the other a video");
  expect_failure("depth start.avi v.avi -o out", kInput, "start.avi");
  expect_failure("depth . right.png -o out", kInput, "not a file");
  expect_failure("depth left.png --rig rig.json -o out", kInput, "give LEFT and RIGHT");
  expect_failure("depth left.png right.png --layout foo -o out", kUsage, "side-by-side,right-left,top-bottom,bottom-top");
}

TEST_F(Cli, NearSaysHowFarToSearch) {
  const auto searched = [&](const char* near) {
    const Ended ended = run(std::string("depth left.png right.png --rig rig.json -o near --json --near ") + near);
    EXPECT_EQ(ended.exit, 0) << ended.err;
    return nlohmann::json::parse(ended.out, nullptr, false)["max_disparity_px"].get<int>();
  };
  const int half = searched("0.5"), one = searched("1");
  EXPECT_EQ(half % 16, 0);
  EXPECT_GT(half, 2 * (one - 16));  // the disparity at a metre is at least one - 16
  EXPECT_LE(half, 2 * one + 16);
  const std::string pair = "depth left.png right.png -o out ";
  expect_failure(pair + "--near 1", kUsage, "--rig");
  expect_failure(pair + "--rig rig.json --near 1 --max-disparity 32", kUsage, "--max-disparity");
  expect_failure(pair + "--rig rig.json --near 0", kUsage, "--near");
  expect_failure(pair + "--rig rig.json --near 0.01", kInput, "256 disparities");
}

TEST_F(Cli, BadOptions) {
  const std::string pair = "depth left.png right.png -o out ";
  for (const char* n : {"0", "-3", "2049", "99999999999999999999", "many"})
    expect_failure(pair + "--max-disparity " + n, kUsage, "--max-disparity");
  expect_failure(pair + "--matcher magic", kUsage, "magic");
  expect_failure(pair + "--engine warp", kUsage, "warp");
  expect_failure(pair + "--preset best", kUsage, "best");
  expect_failure(pair + "--set levels", kUsage, "NAME=VALUE");
  expect_failure(pair + "--set nothing=1", kUsage, "nothing");
  expect_failure(pair + "--set levels=nan", kUsage, "levels");
  expect_failure(pair + "--threads 0", kUsage, "--threads");
  expect_failure(pair + "--every 0", kUsage, "--every");
  expect_failure(pair + "--what", kUsage, "--what");
  for (const char* window : {"1,2,3", "1,2,3,4,5", "1,2,3,", "1,2,0,4", "-1,2,3,4", "a,b,c,d", "1,2,3,4x", "1,2,3,99999999999"})
    expect_failure(pair + "--window=" + window, kUsage, std::string(window) + "' is not X,Y,W,H");
  expect_failure(pair + "--window 160,0,5,5", kInput, "outside the rectified left picture, which is 160x120");
  expect_failure("depth -o out", kUsage, "LEFT");
  expect_failure("eval middlebury nowhere", kInput, "nowhere");
  expect_failure("bench --instructions none", kInput, "\"none\": this build has");
}

TEST_F(Cli, BadRigs) {
  const std::string pair = "depth left.png right.png -o out --rig ";
  write_rig("other.json", [](Rig& rig) { rig = synthetic_rig({.size = {320, 240}}); });
  const std::string rig = bytes_of(at("rig.json"));
  put(at("cut.json"), std::string_view(rig).substr(0, rig.size() / 2));
  put(at("empty.json"), "");
  put(at("list.json"), "[1, 2, 3]\n");
  const auto with = [&](const char* name, const std::function<void(nlohmann::json&)>& spoil) {
    nlohmann::json json = nlohmann::json::parse(rig);
    spoil(json);
    put(at(name), json.dump());
  };
  // Whatever the layout: the first matrix of three rows or nine numbers below right_from_left is its rotation.
  const std::function<bool(nlohmann::json&, const nlohmann::json&)> replace_first_number = [&](nlohmann::json& j,
                                                                                               const nlohmann::json& value) {
    for (auto& item : j) {
      if (item.is_number()) return item = value, true;
      if (item.is_structured() && replace_first_number(item, value)) return true;
    }
    return false;
  };
  with("skewed.json", [&](nlohmann::json& j) { ASSERT_TRUE(replace_first_number(j["right_from_left"]["rotation"], 0.5)); });
  with("nan.json", [&](nlohmann::json& j) { ASSERT_TRUE(replace_first_number(j["right_from_left"]["rotation"], nullptr)); });
  for (const char* name : {"missing.json", "other.json", "cut.json", "empty.json", "list.json", "skewed.json", "nan.json"})
    expect_failure(pair + name, kInput, std::string(name) == "other.json" ? "320x240" : name);
  put(at("nan.yml"), "%YAML:1.0\nM1: [.nan, 0, 1, 0, 1, 1, 0, 0, 1]\n");
  expect_failure(pair + "nan.yml", kInput, "nan.yml");
}

TEST_F(Cli, BadOutputs) {
  put(at("file"), "in the way");
  expect_failure("depth left.png right.png --max-disparity 16 -o file", kOutput, "file");
  expect_failure("depth left.png right.png --max-disparity 16 -o file/deeper", kOutput, "file");
  expect_failure("depth left.png right.png --max-disparity 16 -o /proc/duoptic", kOutput, "/proc/duoptic");
  // A quota of 16 blocks of 512 bytes: the first file does not fit.
  expect_failure("depth left.png right.png --max-disparity 16 -o out", kOutput, "disparity.pfm", "ulimit -f 16;");
  EXPECT_EQ(run("depth left.png right.png --max-disparity 16 -o fine >/dev/full 2>stderr.txt; exit $?").exit, kOutput);
}

TEST_F(Cli, FilesAppearTogetherOrNotAtAll) {
  fs::create_directories(at("taken/disparity.png"));  // a folder has the name of the second file
  const Ended ended = run("depth left.png right.png --max-disparity 16 -o taken");
  EXPECT_EQ(ended.exit, kOutput) << ended.err;
  EXPECT_EQ(std::distance(fs::directory_iterator(at("taken")), fs::directory_iterator()), 1);

  // An earlier run's files stay all where one cannot be replaced, and are replaced all where each can.
  const std::string depth = "depth left.png right.png --rig rig.json --max-disparity 16 -o ";
  ASSERT_EQ(run(depth + "again").exit, 0);
  const std::string depths = bytes_of(at("again/depth.png"));
  for (const char* name : {"disparity.pfm", "disparity.png", "depth.png"}) put(at("again") / name, "earlier");
  fs::remove(at("again/cloud.ply"));
  fs::create_directory(at("again/cloud.ply"));
  EXPECT_EQ(run(depth + "again").exit, kOutput);
  for (const char* name : {"disparity.pfm", "disparity.png", "depth.png"}) EXPECT_EQ(bytes_of(at("again") / name), "earlier");
  fs::remove(at("again/cloud.ply"));
  fs::create_symlink(at("rig.json"), at("again/cloud.ply"));
  const std::string rig = bytes_of(at("rig.json"));
  EXPECT_EQ(run(depth + "again").exit, 0);
  EXPECT_EQ(bytes_of(at("again/depth.png")), depths);
  EXPECT_EQ(bytes_of(at("again/cloud.ply")).rfind("ply\n", 0), 0u);
  EXPECT_EQ(bytes_of(at("rig.json")), rig);
  EXPECT_EQ(std::distance(fs::directory_iterator(at("again")), fs::directory_iterator()), 6);
}

TEST_F(Cli, ScenesWithWrongTypes) {
  fs::create_directory(at("scene"));
  for (const char* meta :
       {R"({"gt_scale": "4", "ndisp": 64})", R"({"gt_scale": 4, "ndisp": [64]})", R"({"gt_scale": 4, "ndisp": 1e300})",
        R"({"gt_scale": 4, "ndisp": 64, "eval_border": {}})", R"({"gt_scale": null, "ndisp": true})", "[4, 64]",
        R"({"gt_scale": 4, "ndisp": 64, "eval_border": -5})", "{", ""}) {
    put(at("scene/meta.json"), meta);
    expect_failure("eval middlebury scene", kInput, "scene/meta.json");
  }
}

TEST_F(Cli, ALargestPictureIsAnOption) {
  expect_failure("depth left.png right.png -o out --max-megapixels 0.019", kInput,
                 "160x120 pixels, more than the 0.019 million");
  expect_failure("--max-megapixels 0.019 depth left.png right.png -o out", kInput, "--max-megapixels reads more");
  expect_failure("depth left.png right.png -o out --max-megapixels 0", kUsage, "--max-megapixels");
  EXPECT_EQ(run("depth left.png right.png --max-disparity 16 -o out --max-megapixels 0.0192").exit, 0);
}

/// Fewer threads than asked for, or none but main()'s: the result does not depend on them. Where the machine refuses memory or
/// files: exit 1, which says so, and nothing is left.
TEST_F(Cli, GoesOnWithFewerThreadsAndSaysWhatTheMachineRefuses) {
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
  GTEST_SKIP() << "skipped: the sanitizer has the memory";
#endif
#endif
  const std::string preload = "LD_PRELOAD='" DUO_FAULTS_LIBRARY "' DUO_FAULTS=";
  const std::string depth = "depth left.png right.png --max-disparity 16 --engine simd --threads 4 ";
  ASSERT_EQ(run(depth + "-o whole").exit, 0);
  // Of those that share a frame, that read pairs and that match them.
  for (const char* threads : {"1", "2", "3", "4", "5", "1+", "3+", "4+", "5+"}) {
    const Ended ended = run(depth + "-o few", preload + "threads=" + threads);
    EXPECT_EQ(ended.exit, 0) << threads << ": " << ended.err;
    EXPECT_EQ(bytes_of(at("few/disparity.pfm")), bytes_of(at("whole/disparity.pfm"))) << threads;
    fs::remove_all(at("few"));
  }
  int refused = 0;
  for (int n = 1; n < 600; n += 1 + n / (test::long_run() ? 4 : 2))
    for (const char* ever : {"", "+"}) {
      const Ended ended = run(depth + "-o out", preload + "memory=" + std::to_string(n) + ever);
      EXPECT_TRUE(ended.exit == 0 || ended.exit == 1) << n << ever << ": " << ended.exit << " " << ended.err;
      EXPECT_TRUE(ended.exit == 0 || ended.err.find("memory") != std::string::npos) << n << ever << ": " << ended.err;
      EXPECT_EQ(ended.exit == 0, fs::exists(at("out"))) << n << ever;
      refused += ended.exit == 1;
      fs::remove_all(at("out"));
    }
  EXPECT_GT(refused, 10);
  for (int n = 1; n < 24; n += test::long_run() ? 1 : 3) {
    const Ended ended = run(depth + "-o out", preload + "files=" + std::to_string(n) + "+");
    EXPECT_TRUE(ended.exit == 0 || ended.exit == 1) << n << ": " << ended.exit << " " << ended.err;
    EXPECT_TRUE(ended.exit == 0 || ended.err.find("Too many open files") != std::string::npos) << n << ": " << ended.err;
    fs::remove_all(at("out"));
  }
}

TEST_F(Cli, ErrorsInJsonToo) {
  const Ended ended = run("depth missing.png right.png --json");
  EXPECT_EQ(ended.exit, kInput);
  const auto json = nlohmann::json::parse(ended.out, nullptr, false);
  ASSERT_TRUE(json.is_object()) << ended.out;
  EXPECT_EQ(json["error"]["exit"], kInput);
  EXPECT_NE(json["error"]["what"].get<std::string>().find("missing.png"), std::string::npos);
}

TEST_F(Cli, HelpHasExamples) {
  for (const char* sub : {"depth", "track", "eval middlebury", "eval clip", "bench", "demo", "version"}) {
    const Ended ended = run(std::string(sub) + " --help");
    EXPECT_EQ(ended.exit, 0) << sub;
    EXPECT_NE(ended.out.find("Example"), std::string::npos) << sub;
  }
}

}  // namespace
}  // namespace duo
