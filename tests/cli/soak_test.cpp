// `duoptic track` on the live synthetic person for a long time: memory stands still, nothing is dropped, and where the machine
// is ours alone, each line is there in time. DUOPTIC_SOAK_S=600 is `make soak`: that long, at 640x480, with latencies checked.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

#include "duoptic/statistics.h"
#include "duoptic/synthetic.h"
#include "tests/data.h"
#include "tool.h"

namespace duo {
namespace {

/// "hand=X,Y" and the other joints of the arm that moves, at the clip's first frame.
std::vector<std::string> clicks(SyntheticClip& clip) {
  const std::string side = clip.setup().arm == SyntheticArm::kLeft ? "left_" : "right_";
  std::vector<std::string> out;
  for (const SyntheticJoint& joint : clip.frame(0).joints)
    for (const char* name : {"hand", "elbow", "shoulder"})
      if (name_of(joint.id) == side + name)
        out.insert(out.end(), {"--select", name + ("=" + std::to_string((*joint.uv_left_px)[0])) + "," +
                                               std::to_string((*joint.uv_left_px)[1])});
  return out;
}

/// The tool in a process of its own, with its lines in a file and a cache folder of its own.
class Tracking {
 public:
  Tracking(std::vector<std::string> arguments, const std::filesystem::path& lines, const std::filesystem::path& cache) {
    arguments.insert(arguments.begin(), {DUO_TOOL, "track"});
    std::vector<char*> raw;
    for (std::string& argument : arguments) raw.push_back(argument.data());
    raw.push_back(nullptr);
    process_ = fork();
    if (process_ != 0) return;
    setenv("XDG_CACHE_HOME", cache.c_str(), 1);
    if (std::freopen(lines.c_str(), "w", stdout) == nullptr) _exit(126);
    execv(raw[0], raw.data());
    _exit(127);
  }
  /// Of its memory now, kB; 0 when it has ended.
  long resident_kb() const {
    std::ifstream status("/proc/" + std::to_string(process_) + "/status");
    for (std::string line; std::getline(status, line);)
      if (line.starts_with("VmRSS:")) return std::stol(line.substr(6));
    return 0;
  }
  /// Ctrl-C; its exit code.
  int end() const {
    kill(process_, SIGINT);
    int status = 0;
    waitpid(process_, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t process_ = -1;
};

TEST(Soak, MemoryStandsStillAndLinesAreInTime) {
  using namespace std::chrono_literals;
  const char* asked = std::getenv("DUOPTIC_SOAK_S");
  const bool alone = asked != nullptr;
  const int seconds = alone ? std::max(20, std::atoi(asked)) : test::long_run() ? 20 : 12;
  const Size size = alone ? Size{640, 480} : Size{320, 240};
  const test::TempFolder folder;
  auto clip = SyntheticClip::open({.size = size, .script = "wave"}, 2);
  ASSERT_TRUE(clip);
  std::vector<std::string> arguments = clicks(*clip);
  ASSERT_EQ(arguments.size(), 6u);
  const std::string source = "synthetic:wave:" + std::to_string(size.width) + "x" + std::to_string(size.height);
  arguments.insert(arguments.begin(), {source, "--stats", "--threads", "2"});
  const auto lines = folder / "lines.jsonl";
  const Tracking tracking(arguments, lines, folder / "cache");
  // Pictures are rendered, large ones coarsely and then once more, and kept in the end.
  const auto rendered = [&] {
    std::error_code none_yet;
    for (const auto& file : std::filesystem::directory_iterator(folder / "cache" / "duoptic", none_yet))
      if (file.path().filename().string().starts_with("synthetic-")) return true;
    return false;
  };
  for (int i = 0; i < 3000 && !rendered() && tracking.resident_kb() > 0; ++i) std::this_thread::sleep_for(100ms);
  ASSERT_TRUE(rendered());
  const std::string meanwhile = test::bytes_of(lines);
  const auto settling = alone ? 10s : 5s;  // until all that is made once is made
  std::this_thread::sleep_for(settling);
  const long before_kb = tracking.resident_kb();
  std::this_thread::sleep_for(std::chrono::seconds(seconds) - settling);
  const long after_kb = tracking.resident_kb();
  ASSERT_EQ(tracking.end(), 0);
  ASSERT_GT(before_kb, 0);
  EXPECT_NEAR(static_cast<double>(after_kb), static_cast<double>(before_kb), 0.01 * static_cast<double>(before_kb));

  std::istringstream all(test::bytes_of(lines).substr(meanwhile.rfind('\n') + 1));
  std::string line;
  std::vector<double> latency_ms;
  long first = -1, last = 0;
  while (std::getline(all, line)) {
    const auto frame = nlohmann::json::parse(line);
    last = frame["frame"];
    if (first < 0) first = last;
    latency_ms.push_back(frame["latency_ms"]);
  }
  ASSERT_GT(latency_ms.size(), 100u);
  const double dropped = 1 - static_cast<double>(latency_ms.size()) / static_cast<double>(last - first + 1);
  const double median_ms = quantile(latency_ms, 0.5), p99_ms = quantile(latency_ms, 0.99);
  std::printf("%zu frames in %d s: latency median %.1f ms, 99 %% %.1f ms; %.2f %% dropped; memory %ld -> %ld kB\n",
              latency_ms.size(), seconds, median_ms, p99_ms, 100 * dropped, before_kb, after_kb);
  if (!alone) return;  // other tests run beside it
  EXPECT_LE(median_ms, 33);
  EXPECT_LE(p99_ms, 50);
  EXPECT_LE(dropped, 0.01);
}

}  // namespace
}  // namespace duo
