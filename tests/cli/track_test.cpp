// `duoptic track` as its users meet it: what it writes on a clip, and what it says of bad input.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "duoptic/rig.h"
#include "duoptic/source.h"
#include "duoptic/synthetic.h"
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

/// A short clip of the synthetic room: a wall to see, on which three clicks lie as far apart as an arm's. Rendered once for all
/// tests.
class Track : public ::testing::Test {
 protected:
  static constexpr int kPairs = 6;
  static constexpr char kSelect[] = " --select hand=160,100 --select elbow=160,77 --select shoulder=160,54 ";

  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TempFolder>();
    const SyntheticSetup setup{.size = {320, 240}};
    auto left = VideoWriter::open(at("left.mp4"), setup.size, 1.0 / 30);
    auto right = VideoWriter::open(at("right.mp4"), setup.size, 1.0 / 30),
         short_right = VideoWriter::open(at("short.mp4"), setup.size, 1.0 / 30),
         blank = VideoWriter::open(at("blank.mp4"), setup.size, 1.0 / 30);
    ASSERT_TRUE(left && right && short_right && blank);
    const SyntheticPair raw = render_synthetic(setup, 2);
    Image<Rgb8> gray(setup.size);
    for (int y = 0; y < gray.height(); ++y) std::fill_n(gray.row(y), gray.width(), Rgb8{128, 128, 128});
    for (int i = 0; i < kPairs; ++i) {
      ASSERT_TRUE(left->write(raw.pair.left.pixels) && right->write(raw.pair.right.pixels) && blank->write(gray));
      ASSERT_TRUE(i >= kPairs - 2 || short_right->write(raw.pair.right.pixels));
    }
    ASSERT_TRUE(left->finish() && right->finish() && short_right->finish() && blank->finish());
    ASSERT_TRUE(save_rig(raw.rig, at("rig.json")));
    ASSERT_TRUE(save_rig(synthetic_rig({.size = {640, 480}}), at("other.json")));
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static fs::path at(const std::string& name) { return *folder_ / name; }

  static Ended run(const std::string& arguments, const std::string& before = "") {
    return test::run_tool(at(""), arguments, before);
  }

  /// One line, its exit code, its words, nothing on stdout and no file.
  static void expect_failure(const std::string& arguments, int exit, const std::string& words, const std::string& before = "") {
    SCOPED_TRACE(arguments);
    const Ended ended = run(arguments + " -o out.jsonl --video out.mp4", before);
    EXPECT_EQ(ended.exit, exit) << ended.err;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_EQ(ended.err.rfind("duoptic track: ", 0), 0u) << ended.err;
    EXPECT_NE(ended.err.find(words), std::string::npos) << ended.err;
    EXPECT_EQ(ended.out, "");
    EXPECT_FALSE(fs::exists(at("out.jsonl")) || fs::exists(at("out.mp4")));
    for (const auto& file : fs::directory_iterator(at(""))) EXPECT_EQ(file.path().extension() == ".partial", false);
  }

  static std::vector<nlohmann::json> lines(const std::string& text) {
    std::vector<nlohmann::json> out;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
      out.push_back(nlohmann::json::parse(line, nullptr, false));
      EXPECT_TRUE(out.back().is_object()) << line;
    }
    return out;
  }

 private:
  inline static std::unique_ptr<test::TempFolder> folder_;
};

TEST_F(Track, HeaderThenALineAFrame) {
  const Ended ended =
      run("track left.mp4 right.mp4 --rig rig.json --at-frame 2" + std::string(kSelect) + "-o a.jsonl --video a.mp4");
  ASSERT_EQ(ended.exit, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  const auto all = lines(bytes_of(at("a.jsonl")));
  ASSERT_EQ(all.size(), 1u + kPairs - 2);
  EXPECT_EQ(all[0]["type"], "header");
  EXPECT_EQ(all[0]["sources"], (nlohmann::json{"left.mp4", "right.mp4"}));
  EXPECT_EQ(all[0]["rig_from_left"].size(), 9u);
  EXPECT_NEAR(all[0]["frame_s"], 1.0 / 30, 1e-6);
  for (std::size_t i = 1; i < all.size(); ++i) {
    EXPECT_EQ(all[i]["frame"], i + 1);  // the first two are skipped
    EXPECT_NEAR(all[i]["t_s"], static_cast<double>(i + 1) / 30, 1e-3);
    ASSERT_EQ(all[i]["people"].size(), 1u);
    const auto& person = all[i]["people"][0];
    EXPECT_EQ(person["id"], 1);
    EXPECT_EQ(person["skeleton"], "right_arm");
    for (const char* joint : {"right_hand", "right_elbow", "right_shoulder"}) {
      const auto& j = person["joints"][joint];
      EXPECT_EQ(j["p_in_rig_m"].is_null(), j["state"] == "lost") << j;
      EXPECT_TRUE(j.contains("uv_left_px") && j.contains("confidence") && j.contains("sigma_m")) << j;
    }
    EXPECT_FALSE(all[i].contains("engine_ms"));
  }
  const auto video = open_source(at("a.mp4"));
  ASSERT_TRUE(video) << video.error().what;
  EXPECT_EQ((*video)->count(), kPairs - 2);
}

TEST_F(Track, TheSameBytesWhateverTheThreads) {
  const std::string arguments = "track left.mp4 right.mp4 --rig rig.json" + std::string(kSelect);
  const Ended one = run(arguments + "--threads 1"), two = run(arguments + "--threads 2"),
              three = run(arguments + "--threads 3");
  ASSERT_EQ(one.exit, 0) << one.err;
  EXPECT_EQ(lines(one.out).size(), 1u + kPairs);
  EXPECT_EQ(one.out, two.out);
  EXPECT_EQ(one.out, three.out);
  EXPECT_EQ(run(arguments + "-o b.jsonl --quiet").out, "");
  EXPECT_EQ(bytes_of(at("b.jsonl")), one.out);
}

/// Two arms by naming both sides' joints; --arm says whose a plain name is.
TEST_F(Track, ArmsByTheNamesOfTheirJoints) {
  const std::string track = "track left.mp4 right.mp4 --rig rig.json";
  const Ended plain = run(track + kSelect + "--arm left");
  ASSERT_EQ(plain.exit, 0) << plain.err;
  const std::string left = " --select left_shoulder=160,54 --select left_hand=160,100 --select left_elbow=160,77";
  EXPECT_EQ(run(track + left).out, plain.out);
  const std::string right = " --select right_hand=190,100 --select right_elbow=190,77 --select right_shoulder=190,54";
  const Ended both = run(track + left + right);
  ASSERT_EQ(both.exit, 0) << both.err;
  const auto people = lines(both.out)[1]["people"];
  ASSERT_EQ(people.size(), 2u);
  EXPECT_EQ(people[0]["skeleton"], "left_arm");
  EXPECT_EQ(people[1]["skeleton"], "right_arm");
  EXPECT_EQ(people[1]["id"], 2);
}

TEST_F(Track, MatchesAroundPeopleUnlessWholeFramesAreWanted) {
  const std::string people = "track left.mp4 right.mp4 --rig rig.json --engine simd --quiet ";
  const auto has_focus = [&](const std::string& options) {
    const Ended ended = run(people + options);
    EXPECT_EQ(ended.exit, 0) << ended.err;
    return nlohmann::json::parse(ended.out.substr(0, ended.out.find('\n'))).contains("focus");
  };
  EXPECT_TRUE(has_focus(""));
  EXPECT_TRUE(has_focus("--focus"));
  EXPECT_FALSE(has_focus("--whole"));
  EXPECT_FALSE(has_focus("--mcap depth.mcap"));  // it holds depth
  EXPECT_EQ(run(people + "--focus --whole").exit, kUsage);
  EXPECT_NE(run(people + "--focus --matcher fine").err.find("cannot match around people alone"), std::string::npos);
}

TEST_F(Track, TimesOnlyWhenAsked) {
  const Ended ended = run("track left.mp4 right.mp4 --rig rig.json --stats" + std::string(kSelect));
  ASSERT_EQ(ended.exit, 0) << ended.err;
  EXPECT_GT(lines(ended.out)[1]["engine_ms"], 0.0);
  EXPECT_NE(ended.err.find("frames/s"), std::string::npos) << ended.err;
}

TEST_F(Track, CutVideoKeepsItsWholeFrames) {
  const std::string whole = bytes_of(at("left.mp4"));
  put(at("cut.mp4"), std::string_view(whole).substr(0, whole.size() - 20));
  const Ended ended = run("track cut.mp4 right.mp4 --rig rig.json -o cut.jsonl" + std::string(kSelect));
  EXPECT_EQ(ended.exit, kCut) << ended.err;
  EXPECT_NE(ended.err.find("cut.mp4 is cut short"), std::string::npos) << ended.err;
  const auto all = lines(bytes_of(at("cut.jsonl")));
  EXPECT_GT(all.size(), 1u);
  EXPECT_LT(all.size(), 1u + kPairs);
}

TEST_F(Track, ABudgetLeavesPairsOut) {
  const std::string track = "track left.mp4 right.mp4 --rig rig.json" + std::string(kSelect);
  // A hundredth of a core pays for one frame of 0.2 s.
  const auto begin = std::chrono::steady_clock::now();
  const Ended ended = run(track + "--realtime --budget 1 --stats -o budget.jsonl");
  const std::chrono::duration<double> took_s = std::chrono::steady_clock::now() - begin;
  EXPECT_EQ(ended.exit, 0) << ended.err;
  const auto kept = lines(bytes_of(at("budget.jsonl"))).size() - 1;
  EXPECT_GE(kept, 1u);
  EXPECT_LE(static_cast<double>(kept), 1 + took_s.count());  // a pair a second comes through in any case
  EXPECT_NE(ended.err.find(" dropped"), std::string::npos) << ended.err;
  expect_failure(track + "--budget 50", kUsage, "add --realtime");
  expect_failure(track + "--realtime --budget 0", kUsage, "--budget");
}

TEST_F(Track, ClipsOfDifferentLengthGiveAWarning) {
  const Ended ended = run("track left.mp4 short.mp4 --rig rig.json -o short.jsonl" + std::string(kSelect));
  EXPECT_EQ(ended.exit, 0) << ended.err;
  EXPECT_NE(ended.err.find("warning: short.mp4 ends after 4 pictures"), std::string::npos) << ended.err;
  EXPECT_EQ(lines(bytes_of(at("short.jsonl"))).size(), 5u);
}

TEST_F(Track, BadSelections) {
  const std::string pair = "track left.mp4 right.mp4 --rig rig.json ";
  const std::string rest = " --select elbow=160,77 --select shoulder=160,54";
  expect_failure(pair + "--tracker arm", kUsage, "--select");
  expect_failure(pair + "--tracker body" + kSelect, kUsage, "leave out");
  expect_failure(pair + "--hands" + kSelect, kUsage, "the tracker arm has no fingers");
  expect_failure(pair + "--hands --tracker thesis" + kSelect, kUsage, "leave out --hands");
  expect_failure(pair + "--select hand=160,100 --select elbow=160,77", kUsage, "right_shoulder is missing");
  expect_failure(pair + "--select hand=1,1 --select hand=2,2" + rest, kUsage, "right_hand is given twice");
  for (const char* bad :
       {"hand", "hand=", "hand=5", "hand=5,", "hand=,5", "hand=a,b", "hand=nan,1", "hand=1e999,1", "hand=1,2,3", "="})
    expect_failure(pair + "--select " + bad + rest, kUsage, "is not JOINT=X,Y");
  expect_failure(pair + "--select foot=1,1" + rest, kUsage, "no joint 'foot'; there are: right_shoulder, right_elbow, ");
  expect_failure(pair + kSelect + "--select left_hand=5,5", kUsage, "left_shoulder is missing");
  expect_failure(pair + kSelect + "--select right_hand=5,5", kUsage, "right_hand is given twice");
  for (const char* outside : {"hand=320,10", "hand=-1,10", "hand=10,240", "hand=1e9,-1e9"})
    expect_failure(pair + "--select " + outside + rest, kInput, "outside");
  expect_failure("track blank.mp4 blank.mp4 --rig rig.json" + std::string(kSelect), kInput, "depth");
  expect_failure(pair + kSelect + "--at-frame 6", kInput, "cannot select at frame 6: left.mp4 gives 6 pairs");
  expect_failure(pair + kSelect + "--at-frame -1", kUsage, "--at-frame");
}

TEST_F(Track, BadInputs) {
  const std::string select = kSelect;
  expect_failure("track left.mp4 right.mp4" + select, kUsage, "--rig");
  expect_failure("track left.mp4 right.mp4 --rig none.json" + select, kInput, "none.json");
  expect_failure("track left.mp4 right.mp4 --rig other.json" + select, kInput, "640x480");
  expect_failure("track left.mp4 none.mp4 --rig rig.json" + select, kInput, "none.mp4");
  expect_failure("track left.mp4 right.mp4 --rig rig.json --tracker best" + select, kUsage, "best");
}

TEST_F(Track, BadOutputs) {
  const std::string track = "track left.mp4 right.mp4 --rig rig.json" + std::string(kSelect);
  const auto fails = [&](const std::string& output, const std::string& words) {
    const Ended ended = run(track + output);
    EXPECT_EQ(ended.exit, kOutput) << ended.err;
    EXPECT_NE(ended.err.find(words), std::string::npos) << ended.err;
  };
  fails("-o none/a.jsonl", "make the folder first");
  fails("--video none/a.mp4 -o never.jsonl", "make the folder first");
  fails("-o .", "folder");
  EXPECT_FALSE(fs::exists(at("never.jsonl")));
  // A quota of 4 blocks of 512 bytes: neither file fits.
  expect_failure(track, kOutput, "out.", "ulimit -f 4;");
  // One does, and is said to be there.
  const Ended half = run(track + "-o large.jsonl --csv small.csv --quiet", "ulimit -f 6;");
  EXPECT_EQ(half.exit, kOutput) << half.err;
  const std::string small = bytes_of(at("small.csv"));
  const auto frames = (std::count(small.begin(), small.end(), '\n') - 1) / 3;  // a row per joint
  EXPECT_GT(frames, 1);
  EXPECT_NE(half.err.find("; " + std::to_string(frames) + " frames are in small.csv\n"), std::string::npos) << half.err;
  EXPECT_FALSE(fs::exists(at("large.jsonl")));
  EXPECT_EQ(run(track + ">/dev/full 2>stderr.txt; exit $?").exit, kOutput);
}

/// What each part of the way costs; what is written is what track writes.
TEST_F(Track, BenchOfAClip) {
  fs::create_directories(at("timed"));
  for (const char* side : {"left", "right"})
    fs::copy_file(at(std::string(side) + ".mp4"), at("timed") / (std::string(side) + ".avi"));
  fs::copy_file(at("rig.json"), at("timed/calibration_truth.yml"));
  ASSERT_EQ(run("track timed/left.avi timed/right.avi --rig rig.json --engine simd --quiet -o timed.jsonl").exit, 0);
  const Ended ended = run("bench --clip timed --repeat 2 --json");
  ASSERT_EQ(ended.exit, 0) << ended.err;
  const auto tables = nlohmann::json::parse(ended.out, nullptr, false);
  ASSERT_EQ(tables.size(), 1u) << ended.out;
  const auto& table = tables[0];
  EXPECT_EQ(table["frames"], kPairs);
  std::map<std::string, nlohmann::json> parts;
  for (const auto& part : table["parts"]) parts[part["part"]] = part;
  for (const char* name : {"decode", "engine", "tracker", "lines", "other"}) ASSERT_TRUE(parts.contains(name)) << name;
  EXPECT_EQ(parts["decode"]["bytes"], 2 * 3 * 320 * 240);
  EXPECT_DOUBLE_EQ(parts["lines"]["bytes"].get<double>() * kPairs, static_cast<double>(fs::file_size(at("timed.jsonl"))));
  double stages_ms = 0;
  std::set<std::string> names;
  for (const auto& stage : parts["engine"]["stages"]) {
    stages_ms += stage["cpu_ms"].get<double>();
    names.insert(stage["stage"]);
  }
  EXPECT_TRUE(names.contains("rectify") && names.contains("semi_global"));
  EXPECT_GT(stages_ms, 0);
  EXPECT_EQ(parts["tracker"]["stages"].size(), 3u);
  ASSERT_EQ(table["track"].size(), 2u);
  for (const auto& track : table["track"]) EXPECT_GT(track["frames_per_s"], 0);

  EXPECT_TRUE(table["focus"].get<bool>());
  const Ended plain = run("bench --clip timed --repeat 1 --whole");
  EXPECT_EQ(plain.exit, 0) << plain.err;
  EXPECT_EQ(plain.out.find("around people"), std::string::npos);
  for (const char* word : {"decode", "  semi_global", "track, 2 threads"})
    EXPECT_NE(plain.out.find(word), std::string::npos) << word;
  EXPECT_EQ(run("bench --clip nowhere").exit, kInput);
  for (const char* of_pictures : {"--what frames", "--size 640x480", "--fine"})
    EXPECT_EQ(run(std::string("bench --clip timed ") + of_pictures).exit, kUsage) << of_pictures;
}

/// The clip of the room with a truth as if the three clicks were joints at 3 m.
TEST_F(Track, EvalClipAgainstATruthFile) {
  fs::create_directories(at("clip"));
  for (const char* side : {"left", "right"})
    fs::copy_file(at(std::string(side) + ".mp4"), at("clip") / (std::string(side) + ".avi"));
  fs::copy_file(at("rig.json"), at("clip/calibration_truth.yml"));
  const auto joint = [](double y_px, bool seen) {
    return nlohmann::json{{"xyz", {0, 0, 3}}, {"uv_left", {160, y_px}}, {"vis_left", seen}, {"vis_right", true}};
  };
  nlohmann::json truth = {{"meta", {{"selected_arm", "left"}}}, {"frames", nlohmann::json::array()}};
  for (int i = 0; i < kPairs; ++i)
    truth["frames"].push_back(
        {{"joints", {{"left_hand", joint(100, i > 0)}, {"left_elbow", joint(77, true)}, {"left_shoulder", joint(54, true)}}}});
  put(at("clip/truth.json"), truth.dump());
  const Ended ended = run("eval clip clip --tracker arm --json");
  ASSERT_EQ(ended.exit, 0) << ended.err;
  const auto report = nlohmann::json::parse(ended.out, nullptr, false);
  ASSERT_TRUE(report.is_object()) << ended.out;
  const auto& clip = report["clips"][0];
  EXPECT_EQ(clip["clip"], "clip");
  EXPECT_EQ(clip["first_frame"], 1);  // the hand is hidden in frame 0
  EXPECT_EQ(clip["frames"], kPairs - 1);
  EXPECT_TRUE(clip["depth"].is_null());
  EXPECT_TRUE(clip["joints"]["left_hand"]["hidden_median_mm"].is_null());
  EXPECT_GT(clip["joints"]["left_hand"]["median_mm"], 100.0);  // the wall is not where this truth has the hand

  // Any joint by its name, of both arms too.
  const Ended one = run("eval clip clip --tracker arm --json --joints left_elbow");
  ASSERT_EQ(one.exit, 0) << one.err;
  const auto elbow = nlohmann::json::parse(one.out, nullptr, false)["clips"][0]["joints"];
  EXPECT_EQ(elbow.size(), 1u);
  EXPECT_EQ(elbow["left_elbow"], clip["joints"]["left_elbow"]);
  EXPECT_EQ(run("eval clip clip --joints elbow").exit, kUsage);

  // Without clicks whole people are looked for; the room has none.
  const Ended nobody = run("eval clip clip --json");
  ASSERT_EQ(nobody.exit, 0) << nobody.err;
  const auto lost = nlohmann::json::parse(nobody.out, nullptr, false)["clips"][0];
  EXPECT_EQ(lost["tracker"], "body");
  EXPECT_EQ(lost["joints"]["left_elbow"]["lost_or_off_percent"], 100.0);
  EXPECT_EQ(lost["joints"].size(), 3u);  // those that the truth has

  // With fingers the same joints are scored: this truth has no fingers.
  const Ended hands = run("eval clip clip --json --hands");
  ASSERT_EQ(hands.exit, 0) << hands.err;
  const auto with_hands = nlohmann::json::parse(hands.out, nullptr, false)["clips"][0];
  EXPECT_EQ(with_hands["tracker"], "body_hands");
  EXPECT_EQ(with_hands["joints"].size(), 3u);

  const auto named = nlohmann::json::parse(run("eval clip clip --json --tracker body_hands").out, nullptr, false)["clips"];
  ASSERT_EQ(named.size(), 1u);
  EXPECT_EQ(named[0]["tracker"], "body_hands");

  const auto fails = [&](const std::string& folder, const std::string& words) {
    const Ended bad = run("eval clip " + folder);
    EXPECT_EQ(bad.exit, kInput) << bad.err;
    EXPECT_EQ(std::count(bad.err.begin(), bad.err.end(), '\n'), 1) << bad.err;
    EXPECT_NE(bad.err.find(words), std::string::npos) << bad.err;
  };
  fails("nowhere", "nowhere");
  fails("clip --joints right_hand", "frame 0 of its truth.json has no right_hand");
  truth["frames"].push_back(truth["frames"][0]);
  put(at("clip/truth.json"), truth.dump());
  fails("clip", "its videos end before frame 6 of 7");
  truth["frames"][0]["joints"].erase("left_elbow");
  put(at("clip/truth.json"), truth.dump());
  fails("clip", "left_elbow");
  put(at("clip/truth.json"), "{");
  fails("clip", "truth.json");
  fs::remove(at("clip/truth.json"));
  fails("clip", "truth.json': there is no such file");
}

}  // namespace
}  // namespace duo
