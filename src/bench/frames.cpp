#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "bench/bench_lines.h"
#include "bench/choices.h"
#include "core/json_text.h"
#include "duoptic/engine.h"
#include "duoptic/peers.h"

namespace duo {
namespace {

// What a whole frame does beside matching.
const std::set<std::string> kNotMatching = {"gray", "median", "gaussian", "rectify", "depth", "color"};

struct Contestant {
  std::string name;
  std::vector<Times> whole, matching;                              // of each run
  std::vector<std::pair<std::string, std::vector<Times>>> stages;  // in the order of the frame
};
struct Table {
  Size size;
  int threads = 1;
  std::vector<Contestant> ours, peers;
};

void add_run(Contestant& c, const Frame& frame, Times whole) {
  c.whole.push_back(whole);
  Times matching;
  std::size_t n = 0;
  for (const StageTime& stage : frame.stages) {
    if (stage.wall_ns == 0) break;
    const Times t{static_cast<double>(stage.wall_ns) / 1e6, static_cast<double>(stage.cpu_ns) / 1e6};
    if (!kNotMatching.contains(stage.stage)) {
      matching.wall_ms += t.wall_ms;
      matching.cpu_ms += t.cpu_ms;
    }
    if (n == c.stages.size()) c.stages.emplace_back(stage.stage, std::vector<Times>());
    c.stages[n++].second.push_back(t);
  }
  c.matching.push_back(matching);
}

constexpr int kWindow = 160;  // px, about an arm at 2 m

struct Ours {
  std::unique_ptr<Engine> engine;
  int repeat;
};

Result<Ours> make_ours(const std::string& engine_name, const BenchChoice& choice, bool fill, const SyntheticPair& input,
                       int threads, int repeat) {
  DUO_TRY_ASSIGN(auto engine, make_engine(engine_name, threads));
  Setup setup;
  setup.size = input.pair.left.pixels.size();
  setup.rig = input.rig;
  setup.matcher = choice.matcher;
  setup.preset = choice.preset;
  setup.fill = fill;
  setup.max_disparity = kBenchDisparities;
  setup.wants = {.color = false, .depth = true};
  setup.time_stages = true;
  DUO_TRY(engine->prepare(setup));
  return Ours{std::move(engine), engine_name == "ref" ? 1 : repeat};
}

Result<Table> measure_frames(const SyntheticPair& input, const FramesBench& options) {
  const int threads = options.threads;
  Table table{input.pair.left.pixels.size(), threads, {}, {}};
  std::vector<Ours> ours;
  for (const char* engine : {"simd", "ref"}) {
    if (options.engine != "both" && options.engine != engine) continue;
    if (std::string(engine) == "ref" && threads > 1) continue;  // the definition runs on one thread
    std::vector<BenchChoice> choices(std::begin(kBenchChoices), std::end(kBenchChoices));
    if (options.fine && std::string(engine) == "simd") choices.push_back({"fine", "default"});
    for (const BenchChoice& choice : choices) {
      DUO_TRY_ASSIGN(auto one, make_ours(engine, choice, true, input, threads, options.repeat));
      ours.push_back(std::move(one));
      table.ours.push_back({fmt::format("{} {} {}", engine, choice.matcher, choice.preset), {}, {}, {}});
    }
    if (std::string(engine) == "ref") continue;
    // Unfilled: what fills a hole may come from anywhere, so that the whole picture would be matched.
    DUO_TRY_ASSIGN(auto sparse, make_ours(engine, kBenchChoices[0], false, input, threads, options.repeat));
    const Window window{(table.size.width - kWindow) / 2, (table.size.height - kWindow) / 2, kWindow, kWindow};
    sparse.engine->look_at({&window, 1});
    ours.push_back(std::move(sparse));
    table.ours.push_back({fmt::format("{} {} window", engine, kBenchChoices[0].matcher), {}, {}, {}});
  }
  std::vector<PeerMatcher> peers;
  const auto run_ours = [&](std::size_t i) {
    std::shared_ptr<const Frame> frame;
    const Times whole = timed([&] {
      ours[i].engine->submit(input.pair);
      frame = ours[i].engine->collect();
    });
    add_run(table.ours[i], *frame, whole);
    if (peers.empty())
      for (const Peer& peer : speed_peers()) peers.emplace_back(peer, frame->left, frame->right, kBenchDisparities);
  };
  for (std::size_t i = 0; i < ours.size(); ++i) run_ours(i);  // warm-up; the reference counts it, it has no caches to warm
  for (const Peer& peer : speed_peers()) table.peers.push_back({fmt::format("OpenCV {}", peer.name), {}, {}, {}});
  for (std::size_t i = 0; i < ours.size(); ++i)
    if (ours[i].repeat > 1) table.ours[i] = {table.ours[i].name, {}, {}, {}};
  for (PeerMatcher& peer : peers) peer.run(threads);
  for (int r = 0; r < options.repeat; ++r) {
    for (std::size_t i = 0; i < ours.size(); ++i)
      if (ours[i].repeat > 1 || table.ours[i].whole.empty()) run_ours(i);
    for (std::size_t i = 0; i < peers.size(); ++i) table.peers[i].matching.push_back(timed([&] { peers[i].run(threads); }));
  }
  return table;
}

nlohmann::json bench_json(Times t) { return {{"wall_ms", t.wall_ms}, {"cpu_ms", t.cpu_ms}}; }

nlohmann::json bench_json(const Table& table) {
  nlohmann::json out = {{"width", table.size.width},
                        {"height", table.size.height},
                        {"threads", table.threads},
                        {"ours", nlohmann::json::array()},
                        {"peers", nlohmann::json::array()}};
  for (const Contestant& p : table.peers)
    out["peers"].push_back({{"name", p.name}, {"matching", bench_json(median_of(p.matching))}});
  for (const Contestant& c : table.ours) {
    nlohmann::json stages = nlohmann::json::array(), ratios = nlohmann::json::object();
    for (const auto& [name, runs] : c.stages) {
      nlohmann::json stage = bench_json(median_of(runs));
      stage["stage"] = name;
      stages.push_back(stage);
    }
    const Times whole = median_of(c.whole), matching = median_of(c.matching);
    for (const Contestant& p : table.peers) {
      const Times theirs = median_of(p.matching);
      ratios[p.name] = {{"whole_wall", whole.wall_ms / theirs.wall_ms},
                        {"whole_cpu", whole.cpu_ms / theirs.cpu_ms},
                        {"matching_wall", matching.wall_ms / theirs.wall_ms},
                        {"matching_cpu", matching.cpu_ms / theirs.cpu_ms}};
    }
    out["ours"].push_back({{"name", c.name},
                           {"whole", bench_json(whole)},
                           {"matching", bench_json(matching)},
                           {"stages", stages},
                           {"frames_per_s", 1000 / whole.wall_ms},
                           {"ratio_to", ratios}});
  }
  return out;
}

void say_table(const Table& table, const SayLine& say) {
  say_format(say, "\n{}x{}, {} disparities, {} thread{}\n", table.size.width, table.size.height, kBenchDisparities,
             table.threads, table.threads == 1 ? "" : "s");
  say_format(say, "{:<22} {:>9} {:>9} {:>9}   {}\n", "", "wall ms", "CPU ms", "frames/s", "stages, CPU ms");
  for (const Contestant& c : table.ours) {
    const Times whole = median_of(c.whole);
    std::string stages;
    for (const auto& [name, runs] : c.stages) stages += fmt::format("{} {:.1f}  ", name, median_of(runs).cpu_ms);
    say_format(say, "{:<22} {:9.1f} {:9.1f} {:9.1f}   {}\n", c.name, whole.wall_ms, whole.cpu_ms, 1000 / whole.wall_ms, stages);
  }
  for (const Contestant& p : table.peers)
    say_format(say, "{:<22} {:9.1f} {:9.1f}             matching call alone\n", p.name, median_of(p.matching).wall_ms,
               median_of(p.matching).cpu_ms);
  for (const Contestant& c : table.ours)
    for (const Contestant& p : table.peers) {
      if (c.whole.size() == 1) continue;  // the reference is no competitor
      const Times whole = median_of(c.whole), matching = median_of(c.matching), theirs = median_of(p.matching);
      say_format(say, "ratio {} / {}: whole frame wall {:.2f}, CPU {:.2f}; matching alone wall {:.2f}, CPU {:.2f}\n", c.name,
                 p.name, whole.wall_ms / theirs.wall_ms, whole.cpu_ms / theirs.cpu_ms, matching.wall_ms / theirs.wall_ms,
                 matching.cpu_ms / theirs.cpu_ms);
    }
}

}  // namespace

Result<std::string> bench_frames(const SyntheticPair& input, const FramesBench& what, const SayLine& say) {
  DUO_TRY_ASSIGN(const Table table, measure_frames(input, what));
  say_table(table, say);
  return json_text(bench_json(table), -1);
}

}  // namespace duo
