#include "bench_device.h"

#include <fmt/format.h>

#include <algorithm>

#include "duoptic/devices.h"
#include "duoptic/engine.h"
#include "timing.h"

namespace duo::app::bench {
namespace {

struct Stage {
  std::string name;
  std::vector<double> ms;
};

/// One choice of matcher, preset and wants on a device.
struct Run {
  std::string name;
  std::vector<double> latency_ms, gpu_ms;
  double own_cpu_ms = 0;  // of the calling thread: packing, submitting, waiting, unpacking
  double frames_per_s = 0;
  std::size_t bytes_up = 0, bytes_down = 0;
  std::vector<Stage> stages;
};

template <class T>
std::size_t bytes_of(const Image<T>& image) {
  return sizeof(T) * static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height());
}

std::size_t bytes_of(const Frame& f) {
  return bytes_of(f.left) + bytes_of(f.right) + bytes_of(f.color) + bytes_of(f.disparity.d_q4) + bytes_of(f.disparity.origin) +
         bytes_of(f.confidence) + bytes_of(f.depth_mm);
}

void add_stages(const Frame& frame, Run& run) {
  double sum_ms = 0;
  std::size_t n = 0;
  for (const StageTime& stage : frame.stages) {
    if (stage.wall_ns == 0) break;
    const double ms = static_cast<double>(stage.wall_ns) * 1e-6;
    sum_ms += ms;
    if (n == run.stages.size()) run.stages.push_back({stage.stage, {}});
    run.stages[n++].ms.push_back(ms);
  }
  run.gpu_ms.push_back(sum_ms);
}

/// As many pairs in flight as the engine takes.
double frames_per_s(Engine& engine, const Pair& pair, int frames) {
  const double begin_ms = clock_ms(CLOCK_MONOTONIC);
  int submitted = 0;
  for (int collected = 0; collected < frames; ++collected) {
    for (; submitted < std::min(frames, collected + engine.in_flight()); ++submitted) engine.submit(pair);
    engine.collect();
  }
  return frames * 1e3 / (clock_ms(CLOCK_MONOTONIC) - begin_ms);
}

Result<Run> measure(Engine& engine, const Setup& setup, const Pair& pair, int repeat, std::string name) {
  Run run;
  run.name = std::move(name);
  DUO_TRY(engine.prepare(setup));
  const auto once = [&]() -> const Frame& {
    engine.submit(pair);
    return engine.collect();
  };
  run.bytes_down = bytes_of(once());
  run.bytes_up = 2 * bytes_of(pair.left.pixels);
  std::vector<double> cpu_ms;
  for (int i = 0; i < repeat; ++i) {
    const double wall = clock_ms(CLOCK_MONOTONIC), cpu = clock_ms(CLOCK_THREAD_CPUTIME_ID);
    const Frame& frame = once();
    run.latency_ms.push_back(clock_ms(CLOCK_MONOTONIC) - wall);
    cpu_ms.push_back(clock_ms(CLOCK_THREAD_CPUTIME_ID) - cpu);
    add_stages(frame, run);
  }
  run.own_cpu_ms = median(cpu_ms);
  run.frames_per_s = frames_per_s(engine, pair, repeat);
  if (const std::string event = engine.take_event(); !event.empty()) return Error{ErrorCode::kDeviceLost, event};
  return run;
}

nlohmann::json json_of(const Run& run) {
  nlohmann::json stages = nlohmann::json::array();
  for (const Stage& stage : run.stages) stages.push_back({{"stage", stage.name}, {"gpu_ms", median(stage.ms)}});
  return {{"name", run.name},
          {"latency_ms", median(run.latency_ms)},
          {"gpu_ms", median(run.gpu_ms)},
          {"calling_thread_cpu_ms", run.own_cpu_ms},
          {"frames_per_s", run.frames_per_s},
          {"bytes_up", run.bytes_up},
          {"bytes_down", run.bytes_down},
          {"stages", stages}};
}

void print(const Run& run) {
  fmt::print("{:<30} {:9.2f} {:9.2f} {:9.2f} {:9.1f} {:8.2f} {:8.2f}  ", run.name, median(run.latency_ms), median(run.gpu_ms),
             run.own_cpu_ms, run.frames_per_s, static_cast<double>(run.bytes_up) * 1e-6,
             static_cast<double>(run.bytes_down) * 1e-6);
  for (const Stage& stage : run.stages) fmt::print("{} {:.2f}  ", stage.name, median(stage.ms));
  fmt::print("\n");
}

}  // namespace

Result<nlohmann::json> device_table(const DeviceBench& what) {
  DUO_TRY_ASSIGN(const auto engine, make_engine(what.engine, 1));
  DUO_TRY_ASSIGN(const DeviceSpeed speed, measure_device(engine->device()));
  const Size size = what.input->pair.left.pixels.size();
  nlohmann::json out = {{"device", engine->device()},     {"width", size.width},      {"height", size.height},
                        {"copy_gb_s", speed.copy_gb_s},   {"up_gb_s", speed.up_gb_s}, {"down_gb_s", speed.down_gb_s},
                        {"ours", nlohmann::json::array()}};
  if (!what.json)
    fmt::print(
        "\n{}x{}, {} disparities, {}: copies {:.1f} GB/s on the device, {:.1f} up, {:.1f} down\n{:<30} {:>9} {:>9} {:>9} {:>9} "
        "{:>8} {:>8}  {}\n",
        size.width, size.height, what.max_disparity, engine->device(), speed.copy_gb_s, speed.up_gb_s, speed.down_gb_s, "",
        "latency", "GPU ms", "CPU ms", "frames/s", "MB up", "MB down", "stages, GPU ms");
  for (const auto& [matcher, preset] : what.choices)
    for (const bool maps : {false, true}) {
      Setup setup;
      setup.size = size;
      setup.rig = what.input->rig;
      setup.matcher = matcher;
      setup.preset = preset;
      setup.max_disparity = what.max_disparity;
      setup.fill = true;
      setup.wants = {.color = maps, .depth = maps, .confidence = false, .views = maps, .disparity = maps};
      setup.time_stages = true;
      DUO_TRY_ASSIGN(const Run run, measure(*engine, setup, what.input->pair, what.repeat,
                                            fmt::format("{} {}{}", matcher, preset, maps ? ", all maps" : "")));
      out["ours"].push_back(json_of(run));
      if (!what.json) print(run), std::fflush(stdout);
    }
  return out;
}

}  // namespace duo::app::bench
