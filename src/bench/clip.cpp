#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bench/bench_lines.h"
#include "core/json_text.h"
#include "duoptic/calibrate.h"
#include "duoptic/pipeline.h"

namespace duo {
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
    std::error_code failed;
    const fs::path all = fs::temp_directory_path(failed);
    if (failed) return;
    std::string name = (all / "duoptic_bench_XXXXXX").string();
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
struct ClipPart {
  std::string name, of;  // of: "" for a part
  double cpu_ms = 0;     // a frame
  double bytes = 0;      // that a part hands on, a frame; of stages 0
};

struct BenchClip {
  fs::path folder;
  Rig rig;
  PipelineSetup setup;
};

struct ClipRun {
  std::vector<ClipPart> parts;
  Times whole;  // of all frames
  int frames = 0;
  bool focus = false;  // around people
};

std::size_t map_bytes_of(const Frame& frame) {
  const auto of = []<class T>(const Image<T>& map) {
    return static_cast<std::size_t>(map.width()) * static_cast<std::size_t>(map.height()) * sizeof(T);
  };
  return of(frame.left) + of(frame.right) + of(frame.left_inside) + of(frame.right_inside) + of(frame.color) +
         of(frame.disparity.d_q4) + of(frame.disparity.origin) + of(frame.confidence) + of(frame.depth_mm);
}

ClipPart& part_of(std::vector<ClipPart>& parts, const std::string& name, const std::string& of) {
  for (ClipPart& part : parts)
    if (part.name == name && part.of == of) return part;
  return parts.emplace_back(ClipPart{name, of});
}

double add_cpu_stages(std::span<const StageTime> stages, const char* of, std::vector<ClipPart>& parts) {
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
Result<ClipRun> run_clip(const BenchClip& clip, const PipelineSetup& setup) {
  ClipRun out;
  LinesFile lines;
  if (!lines.there()) return Error{ErrorCode::kExhausted, "cannot measure writing: no folder for temporary files"};
  double decode_ms = 0, next_ms = 0, write_ms = 0, engine_ms = 0, tracker_ms = 0, maps_bytes = 0, people_bytes = 0;
  DUO_TRY_ASSIGN(auto pairs, open_pairs(clip.setup.names[0], clip.setup.names[1]));
  const Size size = pairs->size();
  DUO_TRY_ASSIGN(Pipeline pipeline, Pipeline::open(std::make_unique<TimedPairs>(std::move(pairs), decode_ms), setup));
  out.focus = pipeline.header().focus;
  DUO_TRY_ASSIGN(auto sink, make_json_lines(lines.path(), pipeline.header()));
  DUO_TRY(pipeline.add_sink("lines", std::move(sink)));
  std::vector<ClipPart> stages;
  Result<Next> next = Next::kNew;
  Result<void> written;
  out.whole = timed([&] {
    while (true) {
      next_ms += timed([&] { next = pipeline.next(); }).cpu_ms;
      if (!next || *next != Next::kNew) return;
      engine_ms += add_cpu_stages(pipeline.frame()->stages, "engine", stages);
      tracker_ms += add_cpu_stages(pipeline.tracker()->stages(), "tracker", stages);
      maps_bytes += static_cast<double>(map_bytes_of(*pipeline.frame()));
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
  std::error_code failed;
  const auto lines_bytes = fs::file_size(lines.path(), failed);
  if (failed)
    return Error{ErrorCode::kWriteFailed, fmt::format("cannot measure {}: {}", lines.path().string(), failed.message())};
  out.parts = {{"decode", "", decode_ms, 6.0 * size.width * size.height * out.frames},
               {"engine", "", engine_ms, maps_bytes},
               {"tracker", "", tracker_ms, people_bytes},
               {"lines", "", write_ms, static_cast<double>(lines_bytes)},
               {"other", "", next_ms - decode_ms - engine_ms - tracker_ms, 0}};
  out.parts.insert(out.parts.end(), stages.begin(), stages.end());
  for (ClipPart& part : out.parts) part.cpu_ms /= out.frames, part.bytes /= out.frames;
  return out;
}

/// Medians of what several runs measured of the same parts.
std::vector<ClipPart> median_parts(const std::vector<ClipRun>& runs) {
  std::vector<ClipPart> out = runs[0].parts;
  for (ClipPart& part : out) {
    std::vector<double> cpu_ms;
    for (const ClipRun& run : runs) {
      std::vector<ClipPart> parts = run.parts;
      cpu_ms.push_back(part_of(parts, part.name, part.of).cpu_ms);
    }
    part.cpu_ms = median_of(std::move(cpu_ms));
  }
  return out;
}

nlohmann::json bench_json(const std::vector<ClipPart>& parts) {
  nlohmann::json out = nlohmann::json::array();
  for (const ClipPart& part : parts) {
    if (!part.of.empty()) continue;
    nlohmann::json stages = nlohmann::json::array();
    for (const ClipPart& stage : parts)
      if (stage.of == part.name) stages.push_back({{"stage", stage.name}, {"cpu_ms", stage.cpu_ms}});
    out.push_back({{"part", part.name}, {"cpu_ms", part.cpu_ms}, {"bytes", part.bytes}, {"stages", stages}});
  }
  return out;
}

void say_clip(const nlohmann::json& table, const SayLine& say) {
  say_format(say, "\n{}: {} pairs of {}x{}, engine {}{}; a frame, one thread, one part after the other\n",
             table["clip"].get<std::string>(), table["frames"].get<int>(), table["width"].get<int>(),
             table["height"].get<int>(), table["engine"].get<std::string>(),
             table["focus"].get<bool>() ? ", around people" : "");
  say_format(say, "{:<22} {:>8} {:>10}\n", "", "CPU ms", "kB handed on");
  double all_ms = 0;
  for (const auto& part : table["parts"]) {
    const double cpu_ms = part["cpu_ms"].get<double>(), bytes = part["bytes"].get<double>();
    all_ms += cpu_ms;
    say_format(say, "{:<22} {:8.2f} {:>10}\n", part["part"].get<std::string>(), cpu_ms,
               bytes > 0 ? fmt::format("{:.1f}", bytes * 1e-3) : std::string());
    for (const auto& stage : part["stages"])
      say_format(say, "  {:<20} {:8.2f}\n", stage["stage"].get<std::string>(), stage["cpu_ms"].get<double>());
  }
  say_format(say, "{:<22} {:8.2f}\n", "all", all_ms);
  for (const auto& run : table["track"])
    say_format(say, "track, {} thread{}: {:.1f} frames/s, {:.1f} ms of CPU time a frame, {:.2f} cores busy\n",
               run["threads"].get<int>(), run["threads"] == 1 ? "" : "s", run["frames_per_s"].get<double>(),
               run["cpu_ms"].get<double>(), run["cores_busy"].get<double>());
}

Result<nlohmann::json> clip_table(const BenchClip& clip, int repeat) {
  constexpr std::array kThreads = {1, 2};
  PipelineSetup alone = clip.setup;
  alone.threads = 1;
  alone.in_turn = true;
  alone.frames.time_stages = true;
  std::vector<ClipRun> parts;
  std::array<std::vector<ClipRun>, kThreads.size()> tracked;
  for (int r = 0; r < repeat; ++r) {
    DUO_TRY_ASSIGN(ClipRun run, run_clip(clip, alone));
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
    for (const ClipRun& run : tracked[i]) whole.push_back(run.whole);
    const Times t = median_of(whole);
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
                        {"engine", clip.setup.engine},
                        {"focus", parts[0].focus},
                        {"parts", bench_json(median_parts(parts))},
                        {"track", runs}};
}

}  // namespace

Result<std::string> bench_clip(const fs::path& folder, const std::string& engine, bool whole, int repeat, const SayLine& say) {
  BenchClip clip{folder, {}, {}};
  DUO_TRY_ASSIGN(clip.rig, load_rig(folder / "calibration_truth.yml"));
  PipelineSetup& setup = clip.setup;
  setup.names = {(folder / "left.avi").string(), (folder / "right.avi").string()};
  setup.engine = engine;
  setup.tracker = "body";
  setup.focus = whole ? PeopleFocus::kOff : PeopleFocus::kWherePossible;
  setup.frames.rig = clip.rig;
  setup.frames.wants = {.color = false, .views = false, .disparity = false};
  DUO_TRY_ASSIGN(setup.frames.max_disparity, disparities_for_people(clip.rig));
  DUO_TRY_ASSIGN(const nlohmann::json table, clip_table(clip, repeat));
  say_clip(table, say);
  return json_text(table, -1);
}

}  // namespace duo
