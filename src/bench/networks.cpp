#include <fmt/format.h>
#include <sched.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "bench/bench_lines.h"
#include "core/json_text.h"
#include "duoptic/detector.h"
#include "duoptic/network.h"

namespace duo {
namespace {

constexpr const char* kNetworks[] = {"person_detector", "body_lite", "body_full", "body_heavy", "hand_lite", "hand_full"};

struct Timed {
  Times ours, peer;
  double alone_ms = 0;  // by one thread, in turn with those of several
  bool has_peer = false;
};

/// Each of two threads on a core of its own: a system may keep both on one core for a while, and then measures itself. Threads
/// that are made run where the one that makes them may.
class Cores {
 public:
  Cores() : usable_(sched_getaffinity(0, sizeof all_, &all_) == 0 && CPU_COUNT(&all_) > 1) {}
  ~Cores() { allow(all_); }
  Cores(const Cores&) = delete;
  Cores& operator=(const Cores&) = delete;
  /// The calling thread, and all that it makes from now on.
  void use(int core) {
    cpu_set_t one;
    CPU_ZERO(&one);
    for (int cpu = 0, i = 0; cpu < CPU_SETSIZE; ++cpu)
      if (CPU_ISSET(cpu, &all_) && i++ == core) CPU_SET(cpu, &one);
    allow(one);
  }

 private:
  void allow(const cpu_set_t& set) {
    if (usable_) sched_setaffinity(0, sizeof set, &set);
  }
  cpu_set_t all_{};
  bool usable_;
};

Result<Timed> measure_network(const std::filesystem::path& path, const std::string& engine, int repeat, int threads) {
  Cores cores;
  if (threads > 1) cores.use(1);  // of the other thread, which is made here
  DUO_TRY_ASSIGN(const auto ours, open_network(path, engine, threads));
  std::unique_ptr<Network> alone, peer;
  if (threads > 1) {
    DUO_TRY_ASSIGN(alone, open_network(path, engine, 1));
  }
  // It refuses one of the layers of body_heavy.
  if (has_xnnpack() && engine == "simd")
    if (auto opened = open_network(path, "XNNPACK", threads)) peer = std::move(*opened);
  if (threads > 1) cores.use(0);
  std::vector<Times> of_ours, of_alone, of_peer;
  Result<void> ran;
  const auto run = [&](Network& network) {
    return timed([&] {
      if (auto result = network.run(); !result) ran = result;
    });
  };
  // Threads of XNNPACK spin for some 50 ms after their work, on the core that ours need. So a turn begins with a rest, and of its
  // runs the quickest counts: what else the machine does is in all others.
  const auto turn = [&](Network& network) {
    if (threads > 1) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    Times best = run(network);
    for (const double end_ms = clock_ms(CLOCK_MONOTONIC) + 60; clock_ms(CLOCK_MONOTONIC) < end_ms;)
      if (const Times next = run(network); next.wall_ms < best.wall_ms) best = next;
    return best;
  };
  if (engine == "ref") of_ours.push_back(run(*ours));
  for (int r = 0; r < repeat && engine != "ref"; ++r) {
    of_ours.push_back(turn(*ours));
    if (alone) of_alone.push_back(turn(*alone));
    if (peer) of_peer.push_back(turn(*peer));
  }
  DUO_TRY(ran);
  return Timed{median_of(of_ours), median_of(of_peer), alone ? median_of(of_alone).wall_ms : 0, peer != nullptr};
}

}  // namespace

Result<std::string> bench_networks(const std::string& engine, int repeat, const SayLine& say_line) {
  nlohmann::json out = nlohmann::json::array();
  const auto say = [&]<class... T>(fmt::format_string<T...> text, T&&... values) {
    say_format(say_line, text, std::forward<T>(values)...);
  };
  for (const int threads : {1, 2}) {
    if (threads > 1 && engine != "simd") break;
    say("\nnetworks, {}\n{:<22} {:>9} {:>9} {:>10}   XNNPACK: {:>9} {:>9} {:>6}\n",
        engine == "simd" ? fmt::format("{} thread{}", threads, threads == 1 ? "" : "s") : engine, "", "wall ms", "CPU ms",
        threads == 1 ? "" : "one thread", "wall ms", "CPU ms", "ratio");
    for (const char* name : kNetworks) {
      const std::filesystem::path path = models_folder() / (std::string(name) + ".net");
      if (std::error_code error; !std::filesystem::exists(path, error)) continue;
      DUO_TRY_ASSIGN(const Timed times, measure_network(path, engine, repeat, threads));
      nlohmann::json row = {
          {"name", name}, {"threads", threads}, {"wall_ms", times.ours.wall_ms}, {"cpu_ms", times.ours.cpu_ms}};
      say("{:<22} {:9.2f} {:9.2f}", name, times.ours.wall_ms, times.ours.cpu_ms);
      if (threads == 1) {
        say(" {:10}", "");
      } else {
        row["speedup"] = times.alone_ms / times.ours.wall_ms;
        say(" {:9.2f}x", times.alone_ms / times.ours.wall_ms);
      }
      if (times.has_peer) {
        const double ratio = times.ours.wall_ms > 0 ? times.peer.wall_ms / times.ours.wall_ms : 0;
        row["xnnpack"] = {{"wall_ms", times.peer.wall_ms}, {"cpu_ms", times.peer.cpu_ms}, {"ratio", ratio}};
        say("            {:9.2f} {:9.2f} {:6.2f}", times.peer.wall_ms, times.peer.cpu_ms, ratio);
      }
      say("\n");
      out.push_back(std::move(row));
    }
  }
  if (out.empty()) say("networks: none in {}\n", models_folder().string());
  return json_text(out, -1);
}

}  // namespace duo
