// `duoptic batch` as its users meet it: what is planned is done, whatever is killed, broken, full or started twice, and is what
// the commands give by themselves.
//
// DUOPTIC_BATCH_ROUNDS=50 is `make batch-chaos`: that many rounds of kills by chance.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "duoptic/recording.h"
#include "duoptic/rig.h"
#include "duoptic/synthetic.h"
#include "process.h"
#include "sinks/clip/avi.h"
#include "tests/data.h"
#include "tool.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::Ended;
using test::kCut;
using test::kInput;
using test::kOutput;
using test::kUsage;
using test::put;
using test::ToolProcess;
using namespace std::chrono_literals;

constexpr Size kBatchPicture = {160, 120};
constexpr int kBatchRecordings = 4;
constexpr char kBatchDepth[] = " --depth --shard-frames 8 -- --max-disparity 16 --outputs depth-video,disparity";
/// An archive of small recordings, no two alike, and what one run without trouble makes of it.
class BatchTool : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TempFolder>();
    const SyntheticPair raw = render_synthetic({.size = kBatchPicture}, 2);
    fs::create_directories(at("archive/day"));
    ASSERT_TRUE(save_rig(raw.rig, at("archive/rig.json")));
    for (int i = 0; i < kBatchRecordings; ++i) {
      const std::string stem = "archive/day/p" + std::to_string(i);
      auto left = AviWriter::open(at(stem + "_left.avi"), kBatchPicture, 30, 90 - i);
      auto right = AviWriter::open(at(stem + "_right.avi"), kBatchPicture, 30, 90 - i);
      ASSERT_TRUE(left && right);
      for (int t = 0; t < 16; ++t) ASSERT_TRUE(left->write(raw.pair.left.pixels) && right->write(raw.pair.right.pixels));
      ASSERT_TRUE(left->finish() && right->finish());
    }
    ASSERT_EQ(run("batch plan archive -o serial" + std::string(kBatchDepth)).exit, 0);
    const Ended ended = run("batch run serial --local --jobs 1 --quiet");
    ASSERT_EQ(ended.exit, 0) << ended.err;
    serial_ = results("serial");
    ASSERT_EQ(serial_.size(), 2u * kBatchRecordings);
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static fs::path at(const std::string& name) { return *folder_ / name; }
  static Ended run(const std::string& arguments, const std::string& before = "") {
    return test::run_tool(at(""), arguments, before);
  }
  static void plan(const std::string& out, const std::string& how = kBatchDepth) {
    fs::remove_all(at(out));
    ASSERT_EQ(run("batch plan archive -o " + out + how).exit, 0);
  }
  /// Of each task the hashes of its results, which are looked at.
  static std::map<std::string, std::string> results(const std::string& out) {
    std::map<std::string, std::string> found;
    if (!fs::exists(at(out + "/done"))) return found;
    for (const auto& entry : fs::directory_iterator(at(out + "/done"))) {
      found[entry.path().filename()] = bytes_of(entry.path() / "SHA256SUMS");
      EXPECT_EQ(std::system(("cd '" + entry.path().string() + "' && sha256sum --check --quiet SHA256SUMS").c_str()), 0);
    }
    return found;
  }
  static void expect_like_serial(const std::string& out) {
    EXPECT_EQ(results(out), serial_);
    EXPECT_TRUE(fs::is_empty(at(out + "/work")));
    EXPECT_TRUE(fs::is_empty(at(out + "/faults")));
  }
  static nlohmann::json status(const std::string& out) { return run("batch status " + out + " --json").json(); }
  static std::string any_key(const std::string& out) { return bytes_of(at(out + "/tasks.txt")).substr(0, 32); }

  inline static std::map<std::string, std::string> serial_;

 private:
  inline static std::unique_ptr<test::TempFolder> folder_;
};

TEST_F(BatchTool, GivesTheFilesOfTheCommandsThemselves) {
  const Ended ended =
      run("depth archive/day/p3_left.avi archive/day/p3_right.avi --rig archive/rig.json --frames 8: --max-disparity 16 "
          "--engine simd "
          "--outputs depth-video,disparity --quiet -o own");
  ASSERT_EQ(ended.exit, 0) << ended.err;
  ASSERT_EQ(run("batch collect serial").exit, 0);
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(at("own"))) {
    if (!entry.is_regular_file()) continue;
    ++files;
    const fs::path name = entry.path().lexically_relative(at("own"));
    EXPECT_EQ(bytes_of(entry.path()) == bytes_of(at("serial/by-name/day/p3.0000000008") / name), true) << name;
  }
  EXPECT_EQ(files, 8 * 2 + 2);  // two of each frame, the video and its camera
  const std::string csv = bytes_of(at("serial/table.csv"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + kBatchRecordings);
  const auto table = nlohmann::json::parse(bytes_of(at("serial/table.json")));
  ASSERT_EQ(table.size(), kBatchRecordings);
  for (const auto& row : table) {
    EXPECT_EQ(row["state"], "done");
    EXPECT_EQ(row["frames"], 16);
    EXPECT_GT(row["coverage_percent"], 10);
    EXPECT_EQ(row["results"].size(), 2u);
  }
}

TEST_F(BatchTool, ARunAgainStartsNothing) {
  plan("again");
  ASSERT_EQ(run("batch run again --local --jobs 2 --quiet").exit, 0);
  expect_like_serial("again");
  const auto before = fs::last_write_time(at("again/done"));
  const Ended ended = run("batch run again --local --jobs 2");
  EXPECT_EQ(ended.exit, 0);
  EXPECT_EQ(ended.out.rfind("8 of 8 done\n", 0), 0u) << ended.out;
  EXPECT_EQ(fs::last_write_time(at("again/done")), before);
  // A line that is edited is done anew, the others are not.
  std::string manifest = bytes_of(at("again/manifest.jsonl"));
  const std::size_t first = manifest.find("\"16\"");
  manifest.replace(first, 4, "\"24\"");
  put(at("again/manifest.jsonl"), manifest);
  EXPECT_EQ(status("again")["missing"], 1);
  EXPECT_EQ(run("batch run again --local --quiet").exit, 0);
  EXPECT_EQ(results("again").size(), serial_.size() + 1);
}

TEST_F(BatchTool, TracksAndTheirTable) {
  const SyntheticSetup setup{.size = {320, 240}};
  const SyntheticPair raw = render_synthetic(setup, 2);
  for (const std::string id : {"p0", "p1"}) {
    fs::create_directories(at("arms/" + id));
    for (const bool right : {false, true}) {
      auto video = AviWriter::open(at("arms/" + id + (right ? "/right.avi" : "/left.avi")), setup.size, 30, 90);
      ASSERT_TRUE(video);
      for (int t = 0; t < 6; ++t) ASSERT_TRUE(video->write((right ? raw.pair.right : raw.pair.left).pixels));
      ASSERT_TRUE(video->finish());
    }
  }
  ASSERT_TRUE(save_rig(raw.rig, at("arms/rig.json")));
  ASSERT_EQ(
      run("batch plan arms -o tracks --track -- --select hand=160,100 --select elbow=160,77 --select shoulder=160,54").exit, 0);
  const Ended ended = run("batch run tracks --local --jobs 2 --json");
  ASSERT_EQ(ended.exit, 0) << ended.out << ended.err;
  EXPECT_EQ(ended.json()["done"], 2);
  const auto files = run("batch collect tracks --json").json();
  const auto table = nlohmann::json::parse(bytes_of(files["json"].get<std::string>()));
  for (const auto& row : table) {
    EXPECT_EQ(row["frames"], 6);
    EXPECT_EQ(row["people_per_frame"], 1.0);
    const auto hand = row["joints"]["right_hand"];
    EXPECT_NEAR(hand["seen"].get<double>() + hand["inferred"].get<double>() + hand["lost"].get<double>(), 1, 1e-9);
  }
  const std::string csv = bytes_of(files["csv"].get<std::string>());
  EXPECT_NE(csv.find("right_hand_seen,right_hand_inferred,right_hand_lost"), std::string::npos);
  EXPECT_TRUE(fs::exists(at("tracks/by-name/p0/people.jsonl")));
}

/// Processes whose parents lead to `root`, itself left out: by /proc.
std::vector<pid_t> descendants(pid_t root) {
  std::map<pid_t, pid_t> parents;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::ifstream stat(entry.path() / "stat");
    std::string line;
    if (!std::getline(stat, line)) continue;
    const std::size_t end = line.rfind(')');
    pid_t parent = 0;
    char state = 0;
    if (end == std::string::npos || std::sscanf(line.c_str() + end + 1, " %c %d", &state, &parent) != 2) continue;
    parents[static_cast<pid_t>(std::atol(line.c_str()))] = parent;
  }
  std::vector<pid_t> out;
  for (auto [id, parent] : parents) {
    for (int depth = 0; depth < 8 && parent > 1 && parent != root; ++depth)
      parent = parents.contains(parent) ? parents[parent] : 0;
    if (parent == root) out.push_back(id);
  }
  return out;
}

/// Workers, their commands and runs themselves are killed by chance; the last run is left alone.
TEST_F(BatchTool, KilledByChanceAllIsDoneAndLikeSerial) {
  const char* wanted = std::getenv("DUOPTIC_BATCH_ROUNDS");
  const int rounds = wanted != nullptr ? std::atoi(wanted) : test::long_run() ? 2 : 1;
  int kills = 0;
  for (int round = 0; round < rounds && !HasFailure(); ++round) {
    SCOPED_TRACE(round);
    plan("chaos");
    std::mt19937 chance(static_cast<unsigned>(round));
    for (int start = 0; start < 3; ++start) {
      ToolProcess process(at(""), "batch run chaos --local --jobs 3 --retries 1000 --quiet", {});
      for (int i = 0; i < 12; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(chance() % 60));
        const auto victims = descendants(process.id());
        if (victims.empty()) continue;
        kill(victims[chance() % victims.size()], SIGKILL);
        ++kills;
      }
      process.send(chance() % 2 == 0 ? SIGKILL : SIGTERM);
      process.end();
      for (const auto& [key, sums] : results("chaos")) EXPECT_EQ(serial_.at(key), sums);  // whatever is there is whole
    }
    const Ended ended = run("batch run chaos --local --jobs 3 --quiet");
    EXPECT_EQ(ended.exit, 0) << ended.err;
    expect_like_serial("chaos");
  }
  EXPECT_GT(kills, 0);
}

TEST_F(BatchTool, StoppedItKeepsWhatIsDoneAndLeavesNothingElse) {
  plan("stopped");
  {
    ToolProcess process(at(""), "batch run stopped --local --jobs 2", {});
    while (!fs::exists(at("stopped/done")) || fs::is_empty(at("stopped/done"))) std::this_thread::sleep_for(2ms);
    process.send(SIGTERM);
    const int exit = process.end();
    EXPECT_TRUE(exit == 128 + SIGTERM || exit == 0) << exit;  // 0: it was done already
  }
  EXPECT_TRUE(fs::is_empty(at("stopped/work")));
  EXPECT_TRUE(fs::is_empty(at("stopped/failed")));
  EXPECT_EQ(run("batch run stopped --local --quiet").exit, 0);
  expect_like_serial("stopped");
}

TEST_F(BatchTool, TwoWorkersOfOneTaskAndADifference) {
  plan("twice");
  ASSERT_EQ(run("batch status twice").exit, 0);  // makes the keys
  const std::string key = any_key("twice"), work = "batch work twice " + key;
  fs::create_directories(at("second"));
  // The first is stopped until the second is done.
  const auto first_waits = [&](const std::function<void()>& meanwhile) {
    ToolProcess first(at(""), work, {});
    while (fs::is_empty(at("twice/work"))) std::this_thread::sleep_for(1ms);
    first.send(SIGSTOP);
    const bool still_works = !fs::exists(at("twice/done/" + key));
    meanwhile();
    first.send(SIGCONT);
    return std::pair(still_works, first.end());
  };
  EXPECT_EQ(first_waits([&] { EXPECT_EQ(test::run_tool(at("second"), "batch work ../twice " + key).exit, 0); }).second, 0);
  EXPECT_EQ(bytes_of(at("twice/done/" + key + "/SHA256SUMS")), serial_.at(key));
  EXPECT_TRUE(fs::is_empty(at("twice/faults")) && fs::is_empty(at("twice/work")));
  fs::remove_all(at("twice/done/" + key));
  const auto [worked, exit] = first_waits([&] {
    fs::copy(at("serial/done/" + key), at("twice/done/" + key), fs::copy_options::recursive);
    put(at("twice/done/" + key + "/SHA256SUMS"), "another machine's\n");
  });
  ASSERT_TRUE(worked);
  EXPECT_EQ(exit, 1);
  const std::string said = bytes_of(at("stderr.txt"));
  EXPECT_NE(said.find("results of day/p"), std::string::npos) << said;
  EXPECT_NE(said.find("differ"), std::string::npos) << said;
  EXPECT_EQ(bytes_of(at("twice/done/" + key + "/SHA256SUMS")), "another machine's\n");  // the first stays
  EXPECT_EQ(status("twice")["faults"].size(), 1u);
  EXPECT_EQ(run("batch run twice --local --quiet").exit, 1);
  // What no worker leaves is done anew.
  put(at("twice/done/" + key + "/done.json"), "{\"exi");
  EXPECT_EQ(run(work).exit, 0);
  EXPECT_EQ(bytes_of(at("twice/done/" + key + "/SHA256SUMS")), serial_.at(key));
}

TEST_F(BatchTool, WhatCannotBeDoneIsListedAndTheRestGoesOn) {
  fs::create_directories(at("bad"));
  const auto take = [&](const std::string& as) {
    fs::copy_file(at("archive/day/p0_left.avi"), at("bad/" + as + "_left.avi"), fs::copy_options::overwrite_existing);
    fs::copy_file(at("archive/day/p0_right.avi"), at("bad/" + as + "_right.avi"), fs::copy_options::overwrite_existing);
  };
  for (const std::string name : {"good", "broken", "cut", "wrong_rig"}) take(name);
  fs::copy_file(at("archive/rig.json"), at("bad/rig.json"));
  put(at("bad/broken_left.avi"), "no video");
  fs::resize_file(at("bad/cut_right.avi"), fs::file_size(at("bad/cut_right.avi")) / 2);
  ASSERT_TRUE(save_rig(synthetic_rig({.size = {640, 480}}), at("bad/wrong_rig_rig.json")));
  ASSERT_EQ(run("batch plan bad -o badly --depth -- --max-disparity 16").exit, 0);
  const Ended ended = run("batch run badly --local");
  EXPECT_EQ(ended.exit, kInput) << ended.err;
  const auto got = status("badly");
  EXPECT_EQ(got["done"], 2);
  EXPECT_EQ(got["cut"], nlohmann::json::array({"cut"}));
  EXPECT_EQ(got["failed"], 2);
  ASSERT_EQ(got["failures"].size(), 2u);
  for (const auto& failure : got["failures"]) {
    EXPECT_EQ(failure["exit"], kInput);
    EXPECT_EQ(failure["tries"], 1);
    const std::string what = failure["what"];
    EXPECT_NE(what.find(": duoptic depth: "), std::string::npos) << what;  // the command's own line
    EXPECT_NE(ended.out.find(what), std::string::npos) << ended.out;
  }
  const auto before = fs::last_write_time(at("badly/failed"));
  EXPECT_EQ(run("batch run badly --local --quiet").exit, kInput);  // the same again would fail again
  EXPECT_EQ(fs::last_write_time(at("badly/failed")), before);
  for (const std::string name : {"broken", "wrong_rig"}) fs::remove(at("bad/" + name + "_left.avi"));
  fs::remove(at("bad/broken_right.avi"));
  fs::remove(at("bad/wrong_rig_right.avi"));
  ASSERT_EQ(run("batch plan bad -o badly --force --depth -- --max-disparity 16").exit, 0);
  EXPECT_EQ(run("batch run badly --local --quiet").exit, kCut);
}

TEST_F(BatchTool, WithoutRoomAndWhereNobodyMayWrite) {
  plan("full");
  const Ended full = run("batch run full --local --retries 1 --quiet", "ulimit -f 40;");
  EXPECT_EQ(full.exit, kOutput) << full.err;
  EXPECT_NE(full.err.find("cannot write"), std::string::npos) << full.err;
  EXPECT_TRUE(fs::is_empty(at("full/work")));
  const auto got = status("full");
  EXPECT_EQ(got["missing"], 2 * kBatchRecordings);
  EXPECT_EQ(got["failures"].size(), 2u * kBatchRecordings);
  for (const auto& failure : got["failures"]) {
    EXPECT_EQ(failure["for_good"], false);
    EXPECT_EQ(failure["tries"], 2);
  }
  EXPECT_EQ(run("batch run full --local --quiet").exit, 0);  // with room again
  expect_like_serial("full");

  // One node's disk is full: what it leaves, others do.
  plan("one_full");
  ASSERT_EQ(run("batch status one_full").exit, 0);
  const Ended on_it = run("batch work one_full " + any_key("one_full"), "ulimit -f 40;");
  EXPECT_EQ(on_it.exit, kOutput) << on_it.err;
  EXPECT_EQ(status("one_full")["failures"].size(), 1u);
  EXPECT_EQ(run("batch run one_full --local --quiet").exit, 0);
  expect_like_serial("one_full");

  plan("closed");
  put(at("closed/work"), "a file");
  const Ended closed = run("batch run closed --local");
  EXPECT_EQ(closed.exit, kOutput);
  EXPECT_EQ(closed.err.rfind("duoptic batch: cannot write", 0), 0u) << closed.err;
  EXPECT_EQ(run("batch plan archive -o archive/rig.json/out").exit, kOutput);
}

TEST_F(BatchTool, BadCalls) {
  const auto fails = [&](const std::string& arguments, int exit, const std::string& words) {
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.exit, exit) << arguments << ended.err;
    EXPECT_NE(ended.err.find(words), std::string::npos) << ended.err;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  };
  fails("batch", kUsage, "subcommand");
  fails("batch run nowhere --local", kInput, "manifest");
  fails("batch plan nowhere -o out", kInput, "archive");
  fails("batch plan archive -o archive", kUsage, "another folder");
  fails("batch plan archive -o serial", kOutput, "--force");
  fails("batch work serial 0", kInput, "no task");
  fails("batch run serial --slurm --local", kUsage, "excludes");
  if (std::system("command -v sbatch >/dev/null") != 0) fails("batch run serial --slurm", kInput, "there is no sbatch");
}

TEST_F(BatchTool, TenThousandRecordings) {
  constexpr int kMany = 10'000;
  for (int i = 0; i < kMany; ++i) {
    const fs::path day = at("many/d" + std::to_string(i % 100));
    if (i < 100) fs::create_directories(day);
    for (const std::string side : {"left", "right"})
      put(day / ("p" + std::to_string(i) + "_" + side + ".avi"), std::to_string(i) + side);
  }
  put(at("many/rig.json"), "rig");
  const auto limited = [&](const std::string& arguments) {
    ToolProcess process(at(""), arguments, {});
    EXPECT_EQ(process.end(), 0) << bytes_of(at("stderr.txt"));
    EXPECT_LE(process.most_memory_mb(), 200) << arguments;
    EXPECT_LE(process.cpu_s(), 5) << arguments;
    RecordProperty(arguments.substr(0, 12), std::to_string(process.cpu_s()));
  };
  limited("batch plan many -o of_many");
  limited("batch status of_many --json");
  EXPECT_EQ(nlohmann::json::parse(bytes_of(at("stdout.txt")))["missing"], kMany);
  std::istringstream tasks(bytes_of(at("of_many/tasks.txt")));
  for (std::string line; std::getline(tasks, line);) {
    const fs::path done = at("of_many/done/" + line.substr(0, 32));
    fs::create_directory(done);
    put(done / "done.json", R"({"exit":0,"host":"h","seconds":1.5,"frames":90})");
  }
  limited("batch status of_many --json");
  const auto got = nlohmann::json::parse(bytes_of(at("stdout.txt")));
  EXPECT_EQ(got["done"], kMany);
  EXPECT_EQ(got["hosts"]["h"]["frames"], 90 * kMany);
}

}  // namespace
}  // namespace duo
