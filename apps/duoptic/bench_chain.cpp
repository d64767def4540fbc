#include "bench_chain.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <filesystem>

#include "duoptic/evaluation.h"
#include "timing.h"
#include "tracking_options.h"

namespace duo::app::bench_chain {
namespace {

namespace fs = std::filesystem;

/// The pairs of another source, and the CPU time that they take. In turn with all other work nobody else's is in it.
class TimedPairs final : public PairSource {
 public:
  TimedPairs(std::unique_ptr<PairSource> pairs, double& cpu_ms) : pairs_(std::move(pairs)), cpu_ms_(cpu_ms) {}
  Size size() const override { return pairs_->size(); }
  std::int64_t count() const override { return pairs_->count(); }
  bool still() const override { return pairs_->still(); }
  double frame_s() const override { return pairs_->frame_s(); }
  std::optional<Rig> rig() const override { return pairs_->rig(); }
  std::string warning() const override { return pairs_->warning(); }
  Result<Next> next(Pair& into) override {
    Result<Next> out = Next::kEnd;
    cpu_ms_ += timed([&] { out = pairs_->next(into); }).cpu_ms;
    return out;
  }

 private:
  std::unique_ptr<PairSource> pairs_;
  double& cpu_ms_;
};

/// A folder of its own for the lines, which go with it.
class LinesFile {
 public:
  LinesFile() {
    std::string name = (fs::temp_directory_path() / "duoptic_bench_XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) folder_ = name;
  }
  ~LinesFile() {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
  }
  LinesFile(const LinesFile&) = delete;
  LinesFile& operator=(const LinesFile&) = delete;
  fs::path path() const { return folder_ / "people.jsonl"; }
  bool there() const { return !folder_.empty(); }

 private:
  fs::path folder_;
};

/// A stage, or the parts that stages belong to.
struct Part {
  std::string name, of;  // of: "" for a part
  double cpu_ms = 0;     // a frame
  double bytes = 0;      // that a part hands on, a frame; of stages 0
};

struct Clip {
  fs::path folder;
  Rig rig;
  PipelineSetup setup;
};

struct Run {
  std::vector<Part> parts;
  Times whole;  // of all frames
  int frames = 0;
  bool focus = false;  // around people
};

std::size_t bytes_of(const Frame& frame) {
  const auto of = []<class T>(const Image<T>& map) {
    return static_cast<std::size_t>(map.width()) * static_cast<std::size_t>(map.height()) * sizeof(T);
  };
  return of(frame.left) + of(frame.right) + of(frame.left_inside) + of(frame.right_inside) + of(frame.color) +
         of(frame.disparity.d_q4) + of(frame.disparity.origin) + of(frame.confidence) + of(frame.depth_mm);
}

Part& part_of(std::vector<Part>& parts, const std::string& name, const std::string& of) {
  for (Part& part : parts)
    if (part.name == name && part.of == of) return part;
  return parts.emplace_back(Part{name, of});
}

double add_stages(std::span<const StageTime> stages, const char* of, std::vector<Part>& parts) {
  double sum_ms = 0;
  for (const StageTime& stage : stages) {
    if (stage.wall_ns == 0) break;
    const double cpu_ms = static_cast<double>(stage.cpu_ns) * 1e-6;
    part_of(parts, stage.stage, of).cpu_ms += cpu_ms;
    sum_ms += cpu_ms;
  }
  return sum_ms;
}

/// The clip from its first frame to its last, in turn where the setup says so.
Result<Run> run_clip(const Clip& clip, const PipelineSetup& setup) {
  Run out;
  LinesFile lines;
  if (!lines.there()) return Error{ErrorCode::kExhausted, "cannot measure writing: no folder for temporary files"};
  double decode_ms = 0, next_ms = 0, write_ms = 0, engine_ms = 0, tracker_ms = 0, maps_bytes = 0, people_bytes = 0;
  DUO_TRY_ASSIGN(auto pairs, open_pairs(clip.setup.names[0], clip.setup.names[1]));
  const Size size = pairs->size();
  DUO_TRY_ASSIGN(Pipeline pipeline, Pipeline::open(std::make_unique<TimedPairs>(std::move(pairs), decode_ms), setup));
  out.focus = pipeline.header().focus;
  DUO_TRY_ASSIGN(auto sink, make_json_lines(lines.path(), pipeline.header()));
  DUO_TRY(pipeline.add_sink("lines", std::move(sink)));
  std::vector<Part> stages;
  Result<Next> next = Next::kNew;
  Result<void> written;
  out.whole = timed([&] {
    while (true) {
      next_ms += timed([&] { next = pipeline.next(); }).cpu_ms;
      if (!next || *next != Next::kNew) return;
      engine_ms += add_stages(pipeline.frame()->stages, "engine", stages);
      tracker_ms += add_stages(pipeline.tracker()->stages(), "tracker", stages);
      maps_bytes += static_cast<double>(bytes_of(*pipeline.frame()));
      people_bytes += static_cast<double>(pipeline.people().size_bytes());
      write_ms += timed([&] { written = pipeline.write(); }).cpu_ms;
      if (!written) return;
      ++out.frames;
    }
  });
  if (!next) return next.error();
  DUO_TRY(written);
  if (out.frames == 0) return Error{ErrorCode::kBadInput, fmt::format("{} holds no pair", clip.folder.string())};
  DUO_TRY(pipeline.finish_sinks());
  out.parts = {{"decode", "", decode_ms, 6.0 * size.width * size.height * out.frames},
               {"engine", "", engine_ms, maps_bytes},
               {"tracker", "", tracker_ms, people_bytes},
               {"lines", "", write_ms, static_cast<double>(fs::file_size(lines.path()))},
               {"other", "", next_ms - decode_ms - engine_ms - tracker_ms, 0}};
  out.parts.insert(out.parts.end(), stages.begin(), stages.end());
  for (Part& part : out.parts) part.cpu_ms /= out.frames, part.bytes /= out.frames;
  return out;
}

/// Medians of what several runs measured of the same parts.
std::vector<Part> median_of(const std::vector<Run>& runs) {
  std::vector<Part> out = runs[0].parts;
  for (Part& part : out) {
    std::vector<double> cpu_ms;
    for (const Run& run : runs) {
      std::vector<Part> parts = run.parts;
      cpu_ms.push_back(part_of(parts, part.name, part.of).cpu_ms);
    }
    part.cpu_ms = median(std::move(cpu_ms));
  }
  return out;
}

nlohmann::json to_json(const std::vector<Part>& parts) {
  nlohmann::json out = nlohmann::json::array();
  for (const Part& part : parts) {
    if (!part.of.empty()) continue;
    nlohmann::json stages = nlohmann::json::array();
    for (const Part& stage : parts)
      if (stage.of == part.name) stages.push_back({{"stage", stage.name}, {"cpu_ms", stage.cpu_ms}});
    out.push_back({{"part", part.name}, {"cpu_ms", part.cpu_ms}, {"bytes", part.bytes}, {"stages", stages}});
  }
  return out;
}

void print(const nlohmann::json& table) {
  fmt::print("\n{}: {} pairs of {}x{}, engine {}{}; a frame, one thread, one part after the other\n",
             table["clip"].get<std::string>(), table["frames"].get<int>(), table["width"].get<int>(),
             table["height"].get<int>(), table["engine"].get<std::string>(),
             table["focus"].get<bool>() ? ", around people" : "");
  fmt::print("{:<22} {:>8} {:>10}\n", "", "CPU ms", "kB handed on");
  double all_ms = 0;
  for (const auto& part : table["parts"]) {
    const double cpu_ms = part["cpu_ms"].get<double>(), bytes = part["bytes"].get<double>();
    all_ms += cpu_ms;
    fmt::print("{:<22} {:8.2f} {:>10}\n", part["part"].get<std::string>(), cpu_ms,
               bytes > 0 ? fmt::format("{:.1f}", bytes * 1e-3) : std::string());
    for (const auto& stage : part["stages"])
      fmt::print("  {:<20} {:8.2f}\n", stage["stage"].get<std::string>(), stage["cpu_ms"].get<double>());
  }
  fmt::print("{:<22} {:8.2f}\n", "all", all_ms);
  for (const auto& run : table["track"])
    fmt::print("track, {} thread{}: {:.1f} frames/s, {:.1f} ms of CPU time a frame, {:.2f} cores busy\n",
               run["threads"].get<int>(), run["threads"] == 1 ? "" : "s", run["frames_per_s"].get<double>(),
               run["cpu_ms"].get<double>(), run["cores_busy"].get<double>());
}

Result<nlohmann::json> chain_table(const Clip& clip, const What& what) {
  constexpr std::array kThreads = {1, 2};
  PipelineSetup alone = clip.setup;
  alone.threads = 1;
  alone.in_turn = true;
  alone.frames.time_stages = true;
  std::vector<Run> parts;
  std::array<std::vector<Run>, kThreads.size()> tracked;
  for (int r = 0; r < what.repeat; ++r) {
    DUO_TRY_ASSIGN(Run run, run_clip(clip, alone));
    parts.push_back(std::move(run));
    for (std::size_t i = 0; i < kThreads.size(); ++i) {
      PipelineSetup setup = clip.setup;
      setup.threads = kThreads[i];
      setup.frames.many_at_once = true;
      setup.check = RigCheck::kTell;
      DUO_TRY_ASSIGN(run, run_clip(clip, setup));
      tracked[i].push_back(std::move(run));
    }
  }
  nlohmann::json runs = nlohmann::json::array();
  for (std::size_t i = 0; i < kThreads.size(); ++i) {
    std::vector<Times> whole;
    for (const Run& run : tracked[i]) whole.push_back(run.whole);
    const Times t = median(whole);
    const double frames = parts[0].frames;
    runs.push_back({{"threads", kThreads[i]},
                    {"frames_per_s", 1000 * frames / t.wall_ms},
                    {"cpu_ms", t.cpu_ms / frames},
                    {"cores_busy", t.cpu_ms / t.wall_ms}});
  }
  return nlohmann::json{{"clip", clip.folder.string()},
                        {"frames", parts[0].frames},
                        {"width", clip.rig.left.size.width},
                        {"height", clip.rig.left.size.height},
                        {"engine", what.engine},
                        {"focus", parts[0].focus},
                        {"parts", to_json(median_of(parts))},
                        {"track", runs}};
}

}  // namespace

Result<nlohmann::json> tables(const What& what) {
  nlohmann::json out = nlohmann::json::array();
  for (const std::string& folder : what.clips) {
    Clip clip{folder, {}, {}};
    DUO_TRY_ASSIGN(clip.rig, load_rig((clip.folder / "calibration_truth.yml").string()));
    TrackingOptions tracking;
    tracking.tracker = "body";
    tracking.focus = what.whole ? PeopleFocus::kOff : PeopleFocus::kWherePossible;
    tracking.engine.engine = what.engine;
    DUO_TRY_ASSIGN(clip.setup, tracking.setup({nullptr, clip.rig, {folder + "/left.avi", folder + "/right.avi"}}));
    DUO_TRY_ASSIGN(nlohmann::json table, chain_table(clip, what));
    if (!what.json) print(table);
    std::fflush(stdout);
    out.push_back(std::move(table));
  }
  return out;
}

}  // namespace duo::app::bench_chain
