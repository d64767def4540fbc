#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "bench/bench_lines.h"
#include "duoptic/detector.h"
#include "duoptic/network.h"

namespace duo {
namespace {

constexpr const char* kNetworks[] = {"person_detector", "body_lite", "body_full", "body_heavy", "hand_lite", "hand_full"};

struct Timed {
  Times ours, peer;
  bool has_peer = false;
};

Result<Timed> measure_network(const std::filesystem::path& path, const std::string& engine, int repeat, int threads) {
  DUO_TRY_ASSIGN(const auto ours, open_network(path, engine, threads));
  std::unique_ptr<Network> peer;
  // It refuses one of the layers of body_heavy.
  if (has_xnnpack() && engine == "simd")
    if (auto opened = open_network(path, "XNNPACK", threads)) peer = std::move(*opened);
  std::vector<Times> of_ours, of_peer;
  Result<void> ran;
  const auto run = [&](Network& network) {
    return timed([&] {
      if (auto result = network.run(); !result) ran = result;
    });
  };
  // Threads of XNNPACK spin for some 50 ms after their work, on the core that ours need; and a system may keep threads that
  // have rested on one core for a while. So a turn begins with a rest, and of its runs the last one counts.
  const auto turn = [&](Network& network) {
    if (threads > 1) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    for (const double end_ms = clock_ms(CLOCK_MONOTONIC) + 60; clock_ms(CLOCK_MONOTONIC) < end_ms;) run(network);
    return run(network);
  };
  if (engine == "ref") of_ours.push_back(run(*ours));
  for (int r = 0; r < repeat && engine != "ref"; ++r) {
    of_ours.push_back(turn(*ours));
    if (peer) of_peer.push_back(turn(*peer));
  }
  DUO_TRY(ran);
  return Timed{median_of(of_ours), median_of(of_peer), peer != nullptr};
}

}  // namespace

Result<std::string> bench_networks(const std::string& engine, int repeat, const SayLine& say_line) {
  nlohmann::json out = nlohmann::json::array();
  const auto say = [&]<class... T>(fmt::format_string<T...> text, T&&... values) {
    say_format(say_line, text, std::forward<T>(values)...);
  };
  std::map<std::string, double> one_thread_ms;  // by network
  for (const int threads : {1, 2}) {
    if (threads > 1 && engine != "simd") break;
    say("\nnetworks, {}\n{:<22} {:>9} {:>9} {:>10}   XNNPACK: {:>9} {:>9} {:>6}\n",
        engine == "simd" ? fmt::format("{} thread{}", threads, threads == 1 ? "" : "s") : engine, "", "wall ms", "CPU ms",
        threads == 1 ? "" : "one thread", "wall ms", "CPU ms", "ratio");
    for (const char* name : kNetworks) {
      const std::filesystem::path path = models_folder() / (std::string(name) + ".net");
      if (!std::filesystem::exists(path)) continue;
      DUO_TRY_ASSIGN(const Timed times, measure_network(path, engine, repeat, threads));
      nlohmann::json row = {
          {"name", name}, {"threads", threads}, {"wall_ms", times.ours.wall_ms}, {"cpu_ms", times.ours.cpu_ms}};
      say("{:<22} {:9.2f} {:9.2f}", name, times.ours.wall_ms, times.ours.cpu_ms);
      if (threads == 1) {
        one_thread_ms[name] = times.ours.wall_ms;
        say(" {:10}", "");
      } else {
        row["speedup"] = one_thread_ms[name] / times.ours.wall_ms;
        say(" {:9.2f}x", one_thread_ms[name] / times.ours.wall_ms);
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
  return out.dump();
}

}  // namespace duo
