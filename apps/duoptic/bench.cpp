// duoptic bench: time of each stage and of whole frames, beside OpenCV's matchers in the same process on the same pair; of
// networks.
#include <fmt/format.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "bench_chain.h"
#include "bench_device.h"
#include "bench_networks.h"
#include "command.h"
#include "duoptic/interrupt.h"
#include "duoptic/peers.h"
#include "duoptic/synthetic.h"
#include "timing.h"

namespace duo::app::bench {
namespace {

constexpr char kFooter[] =
    "The pair is our synthetic room seen by two distorted, noisy cameras. A whole frame goes from decoded pictures to depth:\n"
    "denoise, rectify, match, check, fill, depth; \"window\": depth only in 160x160 pixels amid the picture, unfilled. OpenCV\n"
    "gets the same rectified pair; its time is its matching call alone, "
    "and is\n"
    "compared with our whole frame and with our matching alone. All contestants take turns in one process; medians.\n"
    "On a device: GPU time of each stage, latency from pictures in memory to the frame, CPU time of the calling thread, "
    "frames/s\n"
    "with two pairs in flight, bytes each way, with and without maps sent back and filled by the CPU; and how fast the device "
    "copies.\n"
    "Networks: the whole of each on one picture. XNNPACK runs the same layers in floating point, where this build has it, with "
    "the "
    "best\n"
    "instructions of the processor; the ratio is its wall time by ours. \"one thread\":\n"
    "how many times faster than on one thread.\n"
    "With --clip: the whole way from two videos to joints, and nothing else. A table of CPU time and bytes a frame, part by "
    "part;\n"
    "below it duoptic track. A clip is a folder with left.avi, right.avi and calibration_truth.yml, as duoptic synth writes "
    "it.\n\n"
    "Examples:\n"
    "  duoptic bench\n"
    "  duoptic bench --engine simd --size 640x480 --repeat 31 --json\n"
    "  duoptic bench --engine simd --instructions AVX2\n"
    "  duoptic bench --what networks\n"
    "  duoptic bench --engine vulkan\n"
    "  duoptic bench --clip clip --repeat 3 --instructions AVX2";

constexpr int kMaxDisparity = 128;
// What a whole frame does beside matching.
const std::set<std::string> kNotMatching = {"gray", "median", "gaussian", "rectify", "depth", "color"};

struct Options {
  std::string what = "all", engine = "both", size = "both", instructions;
  std::vector<std::string> clips;
  int repeat = 11;
  bool fine = false, whole = false, json = false;
};

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

struct Choice {
  const char *matcher, *preset;
};
constexpr Choice kChoices[] = {{"sgm", "default"}, {"sgm", "paths8"}, {"pyramid", "default"}, {"pyramid", "thesis"}};

constexpr int kWindow = 160;  // px, about an arm at 2 m

struct Ours {
  std::unique_ptr<Engine> engine;
  int repeat;
};

Result<Ours> make_ours(const std::string& engine_name, const Choice& choice, bool fill, const SyntheticPair& input, int threads,
                       int repeat) {
  DUO_TRY_ASSIGN(auto engine, make_engine(engine_name, threads));
  Setup setup;
  setup.size = input.pair.left.pixels.size();
  setup.rig = input.rig;
  setup.matcher = choice.matcher;
  setup.preset = choice.preset;
  setup.fill = fill;
  setup.max_disparity = kMaxDisparity;
  setup.wants = {.color = false, .depth = true};
  setup.time_stages = true;
  DUO_TRY(engine->prepare(setup));
  return Ours{std::move(engine), engine_name == "ref" ? 1 : repeat};
}

Result<Table> measure(const SyntheticPair& input, int threads, const Options& options) {
  Table table{input.pair.left.pixels.size(), threads, {}, {}};
  std::vector<Ours> ours;
  for (const char* engine : {"simd", "ref"}) {
    if (options.engine != "both" && options.engine != engine) continue;
    if (std::string(engine) == "ref" && threads > 1) continue;  // the definition runs on one thread
    std::vector<Choice> choices(std::begin(kChoices), std::end(kChoices));
    if (options.fine && std::string(engine) == "simd") choices.push_back({"fine", "default"});
    for (const Choice& choice : choices) {
      DUO_TRY_ASSIGN(auto one, make_ours(engine, choice, true, input, threads, options.repeat));
      ours.push_back(std::move(one));
      table.ours.push_back({fmt::format("{} {} {}", engine, choice.matcher, choice.preset), {}, {}, {}});
    }
    if (std::string(engine) == "ref") continue;
    // Unfilled: what fills a hole may come from anywhere, so that the whole picture would be matched.
    DUO_TRY_ASSIGN(auto sparse, make_ours(engine, kChoices[0], false, input, threads, options.repeat));
    const Window window{(table.size.width - kWindow) / 2, (table.size.height - kWindow) / 2, kWindow, kWindow};
    sparse.engine->look_at({&window, 1});
    ours.push_back(std::move(sparse));
    table.ours.push_back({fmt::format("{} {} window", engine, kChoices[0].matcher), {}, {}, {}});
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
      for (const Peer& peer : speed_peers()) peers.emplace_back(peer, frame->left, frame->right, kMaxDisparity);
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

/// Our engines use no better instruction set of the processor than this one; OpenCV keeps its own.
Result<void> limit_instructions(const std::string& name) {
  std::vector<std::string> known;
  for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {  // the best ones are the lowest bits
    const std::int64_t target = left & -left;
    known.emplace_back(hwy::TargetName(target));
    if (known.back() != name) continue;
    hwy::DisableTargets(target - 1);
    return {};
  }
  return Error{ErrorCode::kBadInput,
               fmt::format("use the instructions \"{}\": this build has for this processor: {}", name, fmt::join(known, ", "))};
}

bool on_device(const std::string& engine) { return engine == "vulkan" || engine.starts_with("vulkan:"); }

nlohmann::json to_json(Times t) { return {{"wall_ms", t.wall_ms}, {"cpu_ms", t.cpu_ms}}; }

nlohmann::json to_json(const Table& table) {
  nlohmann::json out = {{"width", table.size.width},
                        {"height", table.size.height},
                        {"threads", table.threads},
                        {"ours", nlohmann::json::array()},
                        {"peers", nlohmann::json::array()}};
  for (const Contestant& p : table.peers) out["peers"].push_back({{"name", p.name}, {"matching", to_json(median(p.matching))}});
  for (const Contestant& c : table.ours) {
    nlohmann::json stages = nlohmann::json::array(), ratios = nlohmann::json::object();
    for (const auto& [name, runs] : c.stages) {
      nlohmann::json stage = to_json(median(runs));
      stage["stage"] = name;
      stages.push_back(stage);
    }
    const Times whole = median(c.whole), matching = median(c.matching);
    for (const Contestant& p : table.peers) {
      const Times theirs = median(p.matching);
      ratios[p.name] = {{"whole_wall", whole.wall_ms / theirs.wall_ms},
                        {"whole_cpu", whole.cpu_ms / theirs.cpu_ms},
                        {"matching_wall", matching.wall_ms / theirs.wall_ms},
                        {"matching_cpu", matching.cpu_ms / theirs.cpu_ms}};
    }
    out["ours"].push_back({{"name", c.name},
                           {"whole", to_json(whole)},
                           {"matching", to_json(matching)},
                           {"stages", stages},
                           {"frames_per_s", 1000 / whole.wall_ms},
                           {"ratio_to", ratios}});
  }
  return out;
}

void print(const Table& table) {
  fmt::print("\n{}x{}, {} disparities, {} thread{}\n", table.size.width, table.size.height, kMaxDisparity, table.threads,
             table.threads == 1 ? "" : "s");
  fmt::print("{:<22} {:>9} {:>9} {:>9}   {}\n", "", "wall ms", "CPU ms", "frames/s", "stages, CPU ms");
  for (const Contestant& c : table.ours) {
    const Times whole = median(c.whole);
    std::string stages;
    for (const auto& [name, runs] : c.stages) stages += fmt::format("{} {:.1f}  ", name, median(runs).cpu_ms);
    fmt::print("{:<22} {:9.1f} {:9.1f} {:9.1f}   {}\n", c.name, whole.wall_ms, whole.cpu_ms, 1000 / whole.wall_ms, stages);
  }
  for (const Contestant& p : table.peers)
    fmt::print("{:<22} {:9.1f} {:9.1f}             matching call alone\n", p.name, median(p.matching).wall_ms,
               median(p.matching).cpu_ms);
  for (const Contestant& c : table.ours)
    for (const Contestant& p : table.peers) {
      if (c.whole.size() == 1) continue;  // the reference is no competitor
      const Times whole = median(c.whole), matching = median(c.matching), theirs = median(p.matching);
      fmt::print("ratio {} / {}: whole frame wall {:.2f}, CPU {:.2f}; matching alone wall {:.2f}, CPU {:.2f}\n", c.name, p.name,
                 whole.wall_ms / theirs.wall_ms, whole.cpu_ms / theirs.cpu_ms, matching.wall_ms / theirs.wall_ms,
                 matching.cpu_ms / theirs.cpu_ms);
    }
}

Result<Exit> run(const Options& options) {
  Interrupt::end_at_once();
  if (!options.instructions.empty()) DUO_TRY(limit_instructions(options.instructions));
  nlohmann::json out = nlohmann::json::array();
  if (!options.clips.empty()) {
    const std::string engine = options.engine == "both" ? "simd" : options.engine;
    DUO_TRY_ASSIGN(out, bench_chain::tables({options.clips, engine, options.whole, options.repeat, options.json}));
    if (options.json) fmt::print("{}\n", out.dump(2));
    return Exit::kOk;
  }
  for (const Size size : {Size{640, 480}, Size{1280, 720}}) {
    if (options.what == "networks") break;
    if (options.size != "both" && options.size != fmt::format("{}x{}", size.width, size.height)) continue;
    const SyntheticPair input = render_synthetic({.size = size}, 2);
    if (on_device(options.engine)) {
      DeviceBench bench{options.engine, &input, {}, kMaxDisparity, options.repeat, options.json};
      for (const Choice& choice : kChoices) bench.choices.emplace_back(choice.matcher, choice.preset);
      DUO_TRY_ASSIGN(nlohmann::json table, device_table(bench));
      out.push_back(std::move(table));
      continue;
    }
    for (const int threads : {1, 2}) {
      DUO_TRY_ASSIGN(const Table table, measure(input, threads, options));
      if (options.json)
        out.push_back(to_json(table));
      else
        print(table);
      std::fflush(stdout);
    }
  }
  if (options.what != "frames") {
    const std::string engine = options.engine == "both" ? "simd" : options.engine;
    DUO_TRY_ASSIGN(nlohmann::json networks, networks_table({engine, options.repeat, options.json}));
    out.push_back({{"networks", std::move(networks)}});
  }
  if (options.json) fmt::print("{}\n", out.dump(2));
  return Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("bench", "Speed of each stage, whole frames and networks, beside OpenCV and XNNPACK");
  const auto options = std::make_shared<Options>();
  CLI::Option* what = sub->add_option("--what", options->what, "Frames of depth, the networks of duoptic detect, or both")
                          ->check(CLI::IsMember({"all", "frames", "networks"}))
                          ->capture_default_str();
  sub->add_option("--engine", options->engine, "Which of our engines")
      ->check(CLI::Validator(
          [](std::string& name) {
            const bool known = name == "both" || name == "ref" || name == "simd" || on_device(name);
            return known ? std::string() : fmt::format("no engine is called \"{}\"", name);
          },
          "both|ref|simd|vulkan[:DEVICE]"))
      ->capture_default_str();
  CLI::Option* size = sub->add_option("--size", options->size, "Size of the pictures")
                          ->check(CLI::IsMember({"both", "640x480", "1280x720"}))
                          ->capture_default_str();
  sub->add_option("--instructions", options->instructions,
                  "Use no better ones than these, by a name that duoptic version lists; without it, the best there are")
      ->type_name("NAME");
  sub->add_option("--repeat", options->repeat, "Runs of each contestant; the reference runs once")
      ->type_name("N")
      ->check(within(1, 1000))
      ->capture_default_str();
  CLI::Option* clip =
      sub->add_option("--clip", options->clips, "The whole way from the two videos of a clip to joints, part by part")
          ->type_name("DIR")
          ->allow_extra_args(false);
  sub->add_flag("--whole", options->whole, "Of --clip: match each frame as a whole, as duoptic track --whole does")
      ->needs(clip);
  CLI::Option* fine = sub->add_flag("--fine", options->fine, "With the matcher fine of engine simd, too: seconds a frame");
  for (CLI::Option* other : {what, size, fine}) clip->excludes(other);
  sub->add_flag("--json", options->json, "Print it as JSON");
  sub->footer(kFooter);
  return {sub, [options] { return run(*options); }};
}

}  // namespace duo::app::bench
