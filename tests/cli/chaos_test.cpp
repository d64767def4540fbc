// Rounds of faults by chance: the tool is killed, stopped, refused memory, files, threads and room, given damaged input, and
// finds others' files and links where it wants to write. Whatever happens, it ends with an exit code that the README tells,
// says why, touches no file that is not its own, and leaves each output whole or not at all.
//
// DUOPTIC_CHAOS_ROUNDS=1000 is `make chaos`: that many rounds. DUOPTIC_CHAOS_SEED=N repeats round N.
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <random>
#include <set>

#include "duoptic/recording.h"
#include "duoptic/rig.h"
#include "duoptic/sink.h"
#include "duoptic/source.h"
#include "duoptic/synthetic.h"
#include "process.h"
#include "sinks/clip/avi.h"
#include "tests/data.h"
#include "tool.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::put;
using test::ToolProcess;

constexpr int kPairs = 6;
constexpr Size kPicture = {160, 120};
constexpr char kPrecious[] = "precious\n";

/// What each round reads: made once.
class Inputs {
 public:
  Inputs() {
    const SyntheticPair raw = render_synthetic({.size = kPicture}, 2);
    EXPECT_TRUE(write_png(raw.pair.left.pixels, folder_ / "left.png") &&
                write_png(raw.pair.right.pixels, folder_ / "right.png"));
    EXPECT_TRUE(save_rig(raw.rig, folder_ / "rig.json"));
    auto left = AviWriter::open(folder_ / "left.avi", kPicture, 30, 90),
         right = AviWriter::open(folder_ / "right.avi", kPicture, 30, 90);
    auto recorder = Recorder::open(folder_ / "clip.mkv", {.frame_s = 1.0 / 30, .rig = raw.rig});
    EXPECT_TRUE(left && right && recorder);
    for (int i = 0; i < kPairs; ++i) {
      Pair pair;
      pair.left.pixels = raw.pair.left.pixels.clone();
      pair.right.pixels = raw.pair.right.pixels.clone();
      pair.left.t_ns = pair.right.t_ns = TimeNs{i} * 33'333'333;
      EXPECT_TRUE(left->write(raw.pair.left.pixels) && right->write(raw.pair.right.pixels) && recorder->write(pair));
    }
    EXPECT_TRUE(left->finish() && right->finish() && recorder->finish());
  }
  fs::path operator/(const std::string& name) const { return folder_ / name; }

 private:
  test::TempFolder folder_;
};

/// What an output holds must be all of it.
std::string png_fault(const fs::path& path) {
  const auto picture = open_source(path);
  return picture ? "" : picture.error().what;
}
std::string pfm_fault(const fs::path& path) {
  const auto picture = read_pfm(path);
  return picture ? "" : picture.error().what;
}
std::string ply_fault(const fs::path& path) {
  const std::string bytes = bytes_of(path);
  const std::size_t count = bytes.find("element vertex "), end = bytes.find("end_header\n");
  if (count == std::string::npos || end == std::string::npos) return "no header";
  constexpr std::size_t kVertexBytes = 15;
  return bytes.size() == end + 11 + kVertexBytes * std::stoul(bytes.substr(count + 15)) ? "" : "cut";
}
std::string json_fault(const fs::path& path) {
  return nlohmann::json::parse(bytes_of(path), nullptr, false).is_discarded() ? "no JSON" : "";
}
std::string lines_fault(const fs::path& path) {
  std::istringstream text(bytes_of(path));
  int lines = 0;
  for (std::string line; std::getline(text, line); ++lines)
    if (nlohmann::json::parse(line, nullptr, false).is_discarded()) return "a line that is no JSON";
  return lines >= 1 ? "" : "no lines";
}
std::string text_fault(const fs::path& path) {
  const std::string bytes = bytes_of(path);
  return !bytes.empty() && bytes.back() == '\n' ? "" : "its last line has no end";
}
/// `cut`: it may end early, in whole pairs.
std::string video_fault(const fs::path& path, bool cut) {
  auto video = open_source(path);
  if (!video) return video.error().what;
  Picture picture;
  while (true) {
    const auto next = (*video)->next(picture);
    if (!next) return next.error().what;
    if (*next == Next::kEnd || (cut && *next == Next::kCut)) return "";
    if (*next == Next::kCut) return "cut";
  }
}

/// One thing that the tool does, and what it leaves: files that come together or not at all.
struct Work {
  std::string arguments;
  std::vector<std::vector<std::string>> sets;
  bool records = false;  // its file may hold the first pairs alone
  bool lasts = false;    // until it is told to end
};

const std::vector<Work>& works() {
  static const std::string select = " --matcher pyramid --select hand=80,50 --select elbow=80,38 --select shoulder=80,27 ";
  static const std::vector<Work> all = {
      {"depth left.png right.png --rig rig.json --max-disparity 16 --engine simd -o out",
       {{"out/disparity.pfm", "out/disparity.png", "out/depth.png", "out/cloud.ply"}}},
      {"depth clip.mkv --max-disparity 16 --engine simd --every 3 -o out",
       {{"out/frame_000000/disparity.pfm", "out/frame_000000/disparity.png", "out/frame_000000/depth.png",
         "out/frame_000000/cloud.ply"},
        {"out/frame_000003/disparity.pfm", "out/frame_000003/disparity.png", "out/frame_000003/depth.png",
         "out/frame_000003/cloud.ply"}}},
      {"record left.avi right.avi --rig rig.json -o new.mkv", {{"new.mkv"}}, true},
      {"record left.avi right.avi --force -o new.mkv", {{"new.mkv"}}, true},
      {"record clip.mkv -o new.mkv --json", {{"new.mkv"}}, true},
      {"track clip.mkv --engine simd -o arm.jsonl --csv arm.csv --bvh arm.bvh" + select,
       {{"arm.jsonl"}, {"arm.csv"}, {"arm.bvh"}}},
      {"track clip.mkv --engine simd --video arm.mp4 --record new.mkv" + select, {{"arm.mp4"}}, true},
      {"track clip.mkv --engine simd --realtime -o arm.jsonl --csv arm.csv" + select, {{"arm.jsonl"}, {"arm.csv"}}},
      {"play clip.mkv --export parts", {{"parts/left.avi", "parts/right.avi", "parts/times.csv", "parts/rig.json"}}},
      {"synth --frames 2 --size 64x48 -o scene", {{"scene/left.avi", "scene/right.avi", "scene/truth.json"}}},
      {"rig import rig.json -o new.json", {{"new.json"}}},
      {"board -o board.svg", {{"board.svg"}}},
      {"record camera:0 camera:2 -o new.mkv", {{"new.mkv"}}, true, true},
      {"track camera:0 camera:2 --rig rig320.json --engine simd --at-frame 2 -o arm.jsonl --matcher pyramid "
       "--select hand=160,100 --select elbow=160,77 --select shoulder=160,54",
       {{"arm.jsonl"}},
       false,
       true},
  };
  return all;
}

std::string fault_of(const fs::path& path, bool cut) {
  const std::string kind = path.extension();
  if (kind == ".png") return png_fault(path);
  if (kind == ".pfm") return pfm_fault(path);
  if (kind == ".ply") return ply_fault(path);
  if (kind == ".json") return json_fault(path);
  if (kind == ".jsonl") return lines_fault(path);
  if (kind == ".mkv" || kind == ".avi" || kind == ".mp4") return video_fault(path, cut);
  return text_fault(path);
}

class Round {
 public:
  Round(const Inputs& inputs, unsigned seed) : inputs_(inputs), random_(seed), work_(works()[random_() % works().size()]) {}

  /// "" or what went wrong.
  std::string run() {
    prepare();
    disturb();
    ToolProcess tool(folder_ / "", work_.arguments, around_);
    meanwhile(tool);
    exit_ = tool.end();
    const std::string fault = judge();
    return fault.empty() ? "" : fault + "\n  " + story() + "\n  said: " + bytes_of(folder_ / "stderr.txt");
  }

  std::string story() const { return work_.arguments + " [" + story_ + "] exit " + std::to_string(exit_); }
  int exit() const { return exit_; }

 private:
  unsigned below(unsigned n) { return static_cast<unsigned>(random_() % n); }
  void tell(const std::string& what) { story_ += (story_.empty() ? "" : ", ") + what; }

  void prepare() {
    for (const char* name : {"left.png", "right.png", "rig.json", "left.avi", "right.avi", "clip.mkv"})
      fs::copy_file(inputs_ / name, folder_ / name);
    if (work_.lasts) {
      EXPECT_TRUE(save_rig(synthetic_rig({.size = {320, 240}}), folder_ / "rig320.json"));
      for (const char* name : {"left.yuyv", "right.yuyv"}) put(folder_ / name, std::string(320 * 240 * 2, '\x70'));
      around_.environment["LD_PRELOAD"] = DUO_FAKE_CAMERAS;
      around_.environment["DUO_FAKE_FOLDER"] = folder_ / "";
    }
    fs::create_directory(folder_ / "theirs");
    put(folder_ / "theirs/precious", kPrecious);
    theirs_.insert("theirs/precious");
  }

  void disturb() {
    constexpr const char* kKinds[] = {"memory", "memory", "memory", "files",    "threads",
                                      "writes", "syncs",  "names",  "exchanges"};
    if (below(2) == 0 && !work_.lasts) {  // two preloaded libraries would be in each other's way
      const char* kind = kKinds[below(std::size(kKinds))];
      const unsigned most = kind == std::string("memory") ? 2500 : kind == std::string("files") ? 60 : 12;
      const std::string faults = kind + ("=" + std::to_string(1 + below(1 + below(most)))) + (below(2) == 0 ? "+" : "");
      around_.environment["LD_PRELOAD"] = DUO_FAULTS_LIBRARY;
      around_.environment["DUO_FAULTS"] = faults;
      exhausts_ = std::set<std::string>{"memory", "files", "threads"}.contains(kind);
      tell(faults);
    }
    if (below(5) == 0) {
      around_.most_file_bytes = below(1 + below(1 << 17));
      tell("room " + std::to_string(around_.most_file_bytes));
    }
    if (below(4) == 0) damage();
    if (below(4) == 0) occupy();
  }

  void damage() {
    constexpr const char* kNames[] = {"left.png", "rig.json", "left.avi", "right.avi", "clip.mkv"};
    const fs::path path = folder_ / kNames[below(std::size(kNames))];
    std::string bytes = bytes_of(path);
    if (below(2) == 0) bytes.resize(below(static_cast<unsigned>(bytes.size())));
    for (unsigned i = below(20); i > 0 && !bytes.empty(); --i)
      bytes[below(static_cast<unsigned>(bytes.size()))] = static_cast<char>(random_());
    put(path, bytes);
    tell("damaged " + path.filename().string());
  }

  /// Something of another's under the name of an output.
  void occupy() {
    const auto& set = work_.sets[below(static_cast<unsigned>(work_.sets.size()))];
    const std::string name = set[below(static_cast<unsigned>(set.size()))];
    fs::create_directories((folder_ / name).parent_path());
    switch (below(4)) {
      case 0:
        fs::create_symlink(fs::absolute(folder_ / "theirs/precious"), folder_ / name);
        tell("link at " + name);
        break;
      case 1:
        fs::create_directory(folder_ / name);
        put(folder_ / name / "precious", kPrecious);
        theirs_.insert(name + "/precious");
        tell("folder at " + name);
        break;
      case 2:
        EXPECT_EQ(mkfifo((folder_ / name).c_str(), 0600), 0);
        fifo_ = name;
        tell("pipe at " + name);
        break;
      default:
        for (const std::string& one : set) put(folder_ / one, earlier(one));
        earlier_ = set;
        tell("earlier files");
    }
  }
  static std::string earlier(const std::string& name) { return "earlier " + name; }

  void meanwhile(ToolProcess& tool) {
    const auto rest = [&](unsigned most_ms) { std::this_thread::sleep_for(std::chrono::milliseconds(below(most_ms))); };
    if (work_.lasts) {
      rest(1500);
      if (below(3) == 0) {
        put(folder_ / "unplugged", "");
        tell("unplugged");
        exhausts_ = true;  // so is a camera that is gone from the start
        rest(400);
        if (below(2) == 0) fs::remove(folder_ / "unplugged");
      }
    } else if (below(3) != 0) {
      return;
    }
    rest(150);
    if (below(3) == 0) {
      tool.send(SIGSTOP);
      rest(200);
      tool.send(SIGCONT);
      tell("stopped");
    }
    if (!work_.lasts && below(3) == 0) return;
    signal_ = std::array{SIGINT, SIGTERM, SIGKILL}[below(3)];
    tool.send(signal_);
    tell("signal " + std::to_string(signal_));
  }

  std::string judge() const {
    if (exit_ == ToolProcess::kHangs) return "it hangs";
    if (exit_ > 128 && exit_ != 128 + signal_) return "it was ended by signal " + std::to_string(exit_ - 128);
    if (exit_ <= 128 && (exit_ < 0 || exit_ > 5 || exit_ == test::kUsage)) return "an exit code of no meaning";
    if (exit_ == 1 && !exhausts_) return "exit 1 though the machine refused nothing";
    const std::string said = bytes_of(folder_ / "stderr.txt");
    if (exit_ > 0 && exit_ <= 128 && said.find("duoptic") == std::string::npos) return "it does not say why";
    for (const std::string& name : theirs_)
      if (bytes_of(folder_ / name) != kPrecious) return "another's file was touched: " + name;
    if (!fifo_.empty() && !fs::is_fifo(folder_ / fifo_)) return "another's pipe is gone";
    for (const auto& set : work_.sets)
      if (const std::string fault = set_fault(set); !fault.empty()) return fault;
    return exit_ == 128 + SIGKILL ? "" : left_over();
  }

  std::string set_fault(const std::vector<std::string>& set) const {
    std::size_t there = 0, kept = 0, theirs = 0;
    for (const std::string& name : set) {
      const fs::path path = folder_ / name;
      const auto status = fs::symlink_status(path);
      if (!fs::exists(status)) continue;
      if (!fs::is_regular_file(status)) {
        ++theirs;
        continue;
      }
      ++there;
      if (set == earlier_ && bytes_of(path) == earlier(name)) {
        ++kept;
        continue;
      }
      const bool cut = work_.records && exit_ != 0;
      if (const std::string fault = fault_of(path, cut); !fault.empty()) return name + " is not whole: " + fault;
    }
    if (kept != 0 && kept != there) return "some files are of an earlier run, some of this";
    // A kill may come between two names.
    if (exit_ != 128 + SIGKILL && there != 0 && there + theirs != set.size())
      return "a part of " + set.front() + " and the others";
    if (exit_ == 0 && !work_.lasts && there == 0 && theirs == 0) return "exit 0 without " + set.front();
    if (exit_ == 0 && kept != 0) return "exit 0 with the files of an earlier run";
    return "";
  }

  /// Hidden files that it has not removed.
  std::string left_over() const {
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / ""))
      if (entry.path().filename().string().starts_with(".")) return "left over: " + entry.path().filename().string();
    return "";
  }

  const Inputs& inputs_;
  std::mt19937 random_;
  const Work& work_;
  test::TempFolder folder_;
  ToolProcess::Surroundings around_;
  std::set<std::string> theirs_;
  std::string fifo_, story_;
  std::vector<std::string> earlier_;
  bool exhausts_ = false;
  int signal_ = 0, exit_ = -2;
};

TEST(Chaos, EveryRoundEndsWell) {
  const char *rounds_text = std::getenv("DUOPTIC_CHAOS_ROUNDS"), *seed_text = std::getenv("DUOPTIC_CHAOS_SEED");
  const bool alone = rounds_text != nullptr;
  const unsigned first = seed_text != nullptr ? static_cast<unsigned>(std::atoi(seed_text)) : 1;
  const unsigned rounds = seed_text != nullptr ? 1 : alone ? static_cast<unsigned>(std::atoi(rounds_text)) : 1000;
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(alone ? 3600 : test::long_run() ? 30 : 10);
  const Inputs inputs;
  std::atomic<unsigned> next = first, done = 0;
  std::mutex mutex;
  std::map<int, int> exits;
  const auto run = [&] {
    while (std::chrono::steady_clock::now() < until) {
      const unsigned seed = next++;
      if (seed >= first + rounds) return;
      Round round(inputs, seed);
      const std::string fault = round.run();
      const std::lock_guard lock(mutex);
      ++done;
      ++exits[round.exit()];
      if (!fault.empty()) ADD_FAILURE() << "round " << seed << ": " << fault;
      if (seed_text != nullptr) std::printf("%s\n", round.story().c_str());
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 2; ++i) threads.emplace_back(run);
  }
  std::string said;
  for (const auto& [exit, times] : exits) said += " " + std::to_string(exit) + ":" + std::to_string(times);
  std::printf("%u rounds; exit codes%s\n", done.load(), said.c_str());
  EXPECT_GT(done, seed_text != nullptr ? 0u : 10u);
}

}  // namespace
}  // namespace duo
