// The command line itself: help, what was perhaps meant, standard streams, signals, manual pages and completion.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>

#include "duoptic/recording.h"
#include "duoptic/rig.h"
#include "duoptic/sink.h"
#include "duoptic/source.h"
#include "duoptic/synthetic.h"
#include "tests/cli/process.h"
#include "tool.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using test::bytes_of;
using test::Ended;

/// A rendered clip of a few frames and its rig, made once.
class CommandLine : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TempFolder>();
    const SyntheticClipSetup setup{.size = {160, 120}, .seed = 2, .script = "wave", .frames = 12};
    ASSERT_TRUE(write_clip(setup, at("clip"), 2, {}).has_value());
    const SyntheticPair raw = render_synthetic({.size = {160, 120}}, 2);
    ASSERT_TRUE(write_png(raw.pair.left.pixels, at("left.png")));
    ASSERT_TRUE(write_png(raw.pair.right.pixels, at("right.png")));
    ASSERT_TRUE(save_rig(raw.rig, at("rig.json")));
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static fs::path at(const std::string& name) { return *folder_ / name; }
  static Ended run(const std::string& arguments, const std::string& before = "") {
    return test::run_tool(at(""), arguments, before);
  }
  /// Every command with those below it, as `duoptic manual` names their pages.
  static std::vector<std::string> commands() {
    std::vector<std::string> out;
    EXPECT_EQ(run("manual -o man").exit, 0);
    for (const auto& page : fs::directory_iterator(at("man"))) {
      std::string name = page.path().stem().string();
      name.erase(0, std::string("duoptic-").size());
      std::replace(name.begin(), name.end(), '-', ' ');
      out.push_back(name);
    }
    return out;
  }

 private:
  inline static std::unique_ptr<test::TempFolder> folder_;
};

TEST_F(CommandLine, AloneItShowsTheCommands) {
  const Ended alone = run("");
  EXPECT_EQ(alone.exit, 0) << alone.err;
  for (const char* word : {"Usage: duoptic COMMAND", "calibrate", "track", "Rigs:", "--version"})
    EXPECT_NE(alone.out.find(word), std::string::npos) << word;
  EXPECT_EQ(run("help").out, alone.out);
  EXPECT_EQ(run("--help").out, alone.out);
  EXPECT_EQ(run("help eval clip").out, run("eval clip --help").out);
  const Ended version = run("--version");
  EXPECT_EQ(version.exit, 0);
  EXPECT_EQ(version.out.rfind("duoptic ", 0), 0u);
  EXPECT_EQ(std::count(version.out.begin(), version.out.end(), '\n'), 1);
}

TEST_F(CommandLine, HelpFitsTheTerminal) {
  for (const std::string& command : commands())
    for (const auto& [columns, help] : {std::pair(60, " --help"), std::pair(300, " --help-all")}) {
      SCOPED_TRACE(command + help + " " + std::to_string(columns));
      const Ended ended = run(command + help, "COLUMNS=" + std::to_string(columns));
      EXPECT_EQ(ended.exit, 0);
      std::istringstream lines(ended.out);
      for (std::string line; std::getline(lines, line);)
        EXPECT_LE(line.size(), static_cast<std::size_t>(std::min(columns, 100))) << line;
    }
  EXPECT_EQ(run("depth --help").out.find("uniqueness"), std::string::npos);
  EXPECT_NE(run("depth --help-all").out.find("Parameters of --set"), std::string::npos);
}

TEST_F(CommandLine, TellsWhatWasPerhapsMeant) {
  constexpr std::array<std::pair<const char*, const char*>, 30> kMistyped = {
      {{"trak", "track"},
       {"tarck a b", "track"},
       {"dept", "depth"},
       {"depht a b", "depth"},
       {"calib", "calibrate"},
       {"calibrat", "calibrate"},
       {"calibration", "calibrate"},
       {"camera", "cameras"},
       {"cams", "cameras"},
       {"recrod", "record"},
       {"replay", "play"},
       {"detectt", "detect"},
       {"dveices", "devices"},
       {"versoin", "version"},
       {"rig chek", "rig check"},
       {"rig refien", "rig refine"},
       {"eval midlebury", "eval middlebury"},
       {"help syhnt", "synth"},
       {"--verison", "--version"},
       {"depth a b --rigg r", "--rig"},
       {"depth a b --max-dispairty 64", "--max-disparity"},
       {"depth a b --disparity 64", "--max-disparity"},
       {"depth a b --ouput x", "--output"},
       {"depth a b --out x", "--output"},
       {"track a b --selcet hand=1,2", "--select"},
       {"track a b --treads 2", "--threads"},
       {"track a b --real-time", "--realtime"},
       {"calibrate a b --bord chessboard:9x6", "--board"},
       {"calibrate a b --square_mm=25", "--square-mm"},
       {"record a b --second 5", "--seconds"}}};
  for (const auto& [words, meant] : kMistyped) {
    const Ended ended = run(words);
    EXPECT_EQ(ended.exit, test::kUsage) << words;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_NE(ended.err.find(std::string("did you mean ") + meant + "?"), std::string::npos) << words << ": " << ended.err;
  }
  EXPECT_EQ(run("xyzzy").err.find("did you mean"), std::string::npos);
  EXPECT_NE(run("depth a b --vmc 127.0.0.1:1").err.find("duoptic view has"), std::string::npos);
  // What only looks like an option is none: it is another option's value, or a number.
  EXPECT_NE(run("depth left.png right.png --skew-ms -5 -o out").err.find("skew"), std::string::npos);
  EXPECT_NE(run("depth left.png right.png --rig --near -o out").err.find("--near"), std::string::npos);
}

TEST_F(CommandLine, NumbersThatAreNoneGetOnePlainLine) {
  for (const char* number : {"0", "0,5", "nan", "-1", "inf", "1e999", ""})
    for (const char* command : {"depth left.png right.png --rig rig.json -o out --near", "calibrate a b -o out --near",
                                "calibrate a b -o out --square-mm", "depth left.png right.png -o out --far"}) {
      const Ended ended = run(std::string(command) + " '" + number + "'");
      const bool is_far = std::string(command).ends_with("--far");
      SCOPED_TRACE(std::string(command) + " " + number);
      EXPECT_EQ(ended.exit, test::kUsage);
      EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
      EXPECT_NE(ended.err.find(std::string("'") + number + "' is not a number " + (is_far ? "above" : "")), std::string::npos)
          << ended.err;
      EXPECT_FALSE(fs::exists(at("out")));
    }
  EXPECT_NE(run("depth left.png right.png --max-disparity 2.5 -o out").err.find("'2.5' is not a whole number"),
            std::string::npos);
}

TEST_F(CommandLine, OneStreamGoesToStdout) {
  const Ended board = run("board -o -");
  EXPECT_EQ(board.exit, 0) << board.err;
  EXPECT_EQ(board.out.rfind("%PDF", 0), 0u);
  EXPECT_NE(board.err.find("duoptic calibrate left.avi right.avi"), std::string::npos);
  for (const char* name : {"-", "/dev/stdout"}) {
    const Ended rig = run(std::string("rig import rig.json -o ") + name);
    EXPECT_EQ(rig.exit, 0) << rig.err;
    EXPECT_EQ(rig.out, bytes_of(at("rig.json")));
    const std::string track =
        "track clip/left.avi clip/right.avi --rig clip/calibration_truth.yml --model lite --max-disparity 32 ";
    const Ended lines = run(track + "-o " + name), csv = run(track + "--csv " + name);
    EXPECT_EQ(lines.out.rfind("{\"type\":\"header\"", 0), 0u) << lines.err;
    EXPECT_EQ(std::count(lines.out.begin(), lines.out.end(), '\n'), 13);
    EXPECT_EQ(lines.out, run(track).out);
    EXPECT_EQ(csv.out.rfind("frame,", 0), 0u) << csv.out;
  }
  EXPECT_FALSE(fs::exists(at("-")));
  EXPECT_EQ(run("track clip/left.avi clip/right.avi --rig clip/calibration_truth.yml -o - --csv -").exit, test::kUsage);
  EXPECT_EQ(run("rig import rig.json -o - --json").exit, test::kUsage);
  const Ended folder = run("depth left.png right.png -o -");
  EXPECT_EQ(folder.exit, test::kOutput);
  EXPECT_NE(folder.err.find("name a folder"), std::string::npos);
  EXPECT_EQ(run("board -o - >/dev/full 2>stderr.txt #").exit, test::kOutput);
}

TEST_F(CommandLine, ABoardAndItsCalibrationAgree) {
  const Ended board = run("board -o board.svg --board charuco:9x6");
  const std::size_t mm = board.out.find("--square-mm ");
  ASSERT_NE(mm, std::string::npos);
  const std::string square = board.out.substr(mm + 12, board.out.find(' ', mm + 12) - mm - 12);
  EXPECT_NE(bytes_of(at("board.svg")).find("--square-mm " + square), std::string::npos) << "the picture says it, too";
}

TEST_F(CommandLine, StderrChangesNoExitCode) {
  const std::string depth = "depth left.png right.png --max-disparity 16 -o streams";
  for (const char* stream : {"2>&-", "2>/dev/full", "2> >(exit)"}) {
    for (const auto& [words, exit] : std::initializer_list<std::pair<std::string, int>>{
             {depth, 0},
             {"depth nowhere.png right.png", test::kInput},
             {"trak", test::kUsage},
             {"calibrate clip/left.avi clip/right.avi -o r.json", test::kInput}}) {
      const std::string command =
          "cd '" + at("").string() + "' && bash -c \"'" DUO_TOOL "' " + words + " >stdout.txt " + stream + "\"";
      EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), exit) << words << " " << stream;
    }
    EXPECT_TRUE(fs::exists(at("streams/disparity.pfm")));
    fs::remove_all(at("streams"));
  }
  // Files that are opened do not become stderr.
  const Ended lines =
      run("track clip/left.avi clip/right.avi --rig clip/calibration_truth.yml --model lite -o lines.jsonl 2>&- #");
  EXPECT_EQ(lines.exit, 0);
  EXPECT_EQ(bytes_of(at("lines.jsonl")).rfind("{\"type\":\"header\"", 0), 0u);
}

/// What is left is whole: lines, frames and videos; nothing under a hidden name.
void expect_whole(const fs::path& work) {
  if (fs::exists(work / "depth")) {
    for (const auto& frame : fs::directory_iterator(work / "depth")) EXPECT_TRUE(fs::exists(frame.path() / "cloud.ply"));
  }
  for (const auto& entry : fs::recursive_directory_iterator(work)) {
    const std::string ending = entry.path().extension();
    EXPECT_NE(entry.path().filename().string()[0], '.') << entry.path();
    if (ending == ".jsonl" || ending == ".csv" || ending == ".bvh") {
      EXPECT_TRUE(bytes_of(entry.path()).ends_with('\n')) << entry.path();
    } else if (ending == ".json") {
      EXPECT_FALSE(nlohmann::json::parse(bytes_of(entry.path()), nullptr, false).is_discarded()) << entry.path();
    } else if (entry.path().filename() == "clip.mkv") {
      EXPECT_TRUE(inspect_recording(entry.path())) << entry.path();
    } else if (ending == ".mp4" || ending == ".avi" || ending == ".mkv" || ending == ".png") {
      EXPECT_TRUE(open_source(entry.path())) << entry.path();
    }
  }
}

/// Each command, ended by a signal at several moments of its run. batch has a test of its own, and so has the window.
/// DUOPTIC_SIGNALS=20: that many moments each, of its whole run; else one, soon.
TEST_F(CommandLine, SignalsLeaveWholeFrames) {
  const std::string pair = "clip/left.avi clip/right.avi ", rig = "--rig clip/calibration_truth.yml ";
  std::vector<std::string> calls = {
      "depth " + pair + rig + "--max-disparity 32 --threads 1 -o work/depth",
      "depth " + pair + rig + "--max-disparity 32 --outputs depth-video -o work/video",
      "track " + pair + rig + "--model lite -o work/lines.jsonl --csv work/t.csv --bvh work/t.bvh --video work/t.mp4",
      "detect clip/left.avi --model lite -o work/people",
      "record " + pair + "-o work/clip.mkv --force",
      "play kept.mkv --export work/parts",
      "synth --size 160x120 --frames 9 -o work/synth",
      "calibrate " + pair + "-o work/rig.json",
      "board -o work/board.pdf",
      "rig refine " + rig.substr(6) + pair + "-o work/refined.json",
      "rig export rig.json --to ros -o work/ros",
      "eval clip clip --model lite",
      "eval middlebury work",
      "quality " + pair + rig + "--json",
      "manual -o work/man"};
  const char* rounds = std::getenv("DUOPTIC_SIGNALS");
  const int times = rounds != nullptr ? std::atoi(rounds) : 1;
  if (times > 1) calls.insert(calls.end(), {"demo -o work/demo", "bench --size 640x480 --repeat 1", "cameras", "devices"});
  ASSERT_EQ(run("record " + pair + rig + "-o kept.mkv --force --quiet").exit, 0);
  unsigned random = 7;
  for (const std::string& call : calls) {
    std::chrono::milliseconds longest = 400ms;
    if (times > 1) {
      const auto begin = std::chrono::steady_clock::now();
      fs::create_directories(at("work"));
      run(call);
      fs::remove_all(at("work"));
      longest = std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - begin);
    }
    for (int round = 0; round < times; ++round) {
      const int signal = (random >> 20 & 1) != 0 ? SIGINT : SIGTERM;
      SCOPED_TRACE(call + ", signal " + std::to_string(signal));
      fs::create_directories(at("work"));
      test::ToolProcess process(at(""), call, {});
      random = random * 1103515245u + 12345u;
      std::this_thread::sleep_for(random / 65536 % 1000 * longest / 1000);
      process.send(signal);
      const int exit = process.end();
      EXPECT_TRUE(exit == 128 + signal || exit == 0 || exit == test::kInput) << exit << ": " << bytes_of(at("stderr.txt"));
      expect_whole(at("work"));
      fs::remove_all(at("work"));
    }
  }
}

TEST_F(CommandLine, ManualAndCompletionComeFromTheSameTables) {
  for (const std::string& command : commands()) {
    std::string name = command.empty() ? "duoptic" : "duoptic " + command;
    std::replace(name.begin(), name.end(), ' ', '-');
    const std::string page = bytes_of(at("man/" + name + ".1"));
    EXPECT_EQ(page.rfind(".TH " + name + " 1", 0), 0u) << name;
  }
  EXPECT_EQ(run("manual eval clip").out, bytes_of(at("man/duoptic-eval-clip.1")));
  EXPECT_NE(bytes_of(at("man/duoptic-depth.1")).find("\\-\\-max\\-disparity"), std::string::npos);
  ASSERT_EQ(run("completion bash > complete.sh #").exit, 0);
  const auto completed = [](const std::string& words, int at_word) {
    const std::string script = "cd '" + at("").string() + "' && bash -c 'source complete.sh; COMP_WORDS=(" + words +
                               "); COMP_CWORD=" + std::to_string(at_word) + "; _duoptic; echo ${COMPREPLY[@]} > completed.txt'";
    EXPECT_EQ(std::system(script.c_str()), 0);
    return bytes_of(at("completed.txt"));
  };
  EXPECT_EQ(completed("duoptic tra", 1), "track\n");
  EXPECT_EQ(completed("duoptic eval mid", 2), "middlebury\n");
  EXPECT_EQ(completed("duoptic depth a b --max-d", 4), "--max-disparity\n");
  EXPECT_EQ(completed("duoptic depth --matcher s", 3), "sgm\n");
  EXPECT_EQ(completed("duoptic depth le", 2), "\n");
}

}  // namespace
}  // namespace duo
