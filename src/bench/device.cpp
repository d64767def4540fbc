#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/bench_lines.h"
#include "bench/choices.h"
#include "core/json_text.h"
#include "duoptic/devices.h"
#include "duoptic/engine.h"
#include "duoptic/tracker.h"

namespace duo {
namespace {

struct DeviceStage {
  std::string name;
  std::vector<double> ms;
};

/// One choice of matcher, preset and wants on a device.
struct DeviceRun {
  std::string name;
  std::vector<double> latency_ms, gpu_ms;
  double own_cpu_ms = 0;  // of the calling thread: packing, submitting, waiting, unpacking
  double frames_per_s = 0;
  std::size_t bytes_up = 0, bytes_down = 0;
  std::vector<DeviceStage> stages;
};

template <class T>
std::size_t bytes_of(const Image<T>& image) {
  return sizeof(T) * static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height());
}

std::size_t bytes_of(const Frame& f) {
  return bytes_of(f.left) + bytes_of(f.right) + bytes_of(f.color) + bytes_of(f.disparity.d_q4) + bytes_of(f.disparity.origin) +
         bytes_of(f.confidence) + bytes_of(f.depth_mm);
}

/// Of a frame, and of the look at it.
void add_stages(const Frame& frame, std::span<const StageTime> look, DeviceRun& run) {
  double sum_ms = 0;
  std::size_t n = 0;
  const auto add = [&](const StageTime& stage) {
    if (stage.wall_ns == 0) return;
    const double ms = static_cast<double>(stage.wall_ns) * 1e-6;
    if (stage.cpu_ns == 0) sum_ms += ms;  // filling is the CPU's
    if (n == run.stages.size()) run.stages.push_back({stage.stage, {}});
    run.stages[n++].ms.push_back(ms);
  };
  std::for_each(frame.stages.begin(), frame.stages.end(), add);
  std::for_each(look.begin(), look.end(), add);
  run.gpu_ms.push_back(sum_ms);
}

/// The thesis's tracker on three joints at one place: the first of the picture with colour and depth.
///
/// Errors  there is none
Result<std::unique_ptr<Tracker>> tracker_on(const Frame& frame, const Engine& engine, const Rig& rig) {
  constexpr int kStep_px = 24;
  DUO_TRY_ASSIGN(std::unique_ptr<Tracker> tracker, make_tracker("thesis"));
  DUO_TRY(tracker->prepare({rig, *engine.rectified()}));
  Result<std::span<const Person>> selected = Error{ErrorCode::kBadInput, "bench the tracker: the picture is too small"};
  for (int y = rig.left.size.height / 3; y < rig.left.size.height; y += kStep_px)
    for (int x = rig.left.size.width / 3; x < rig.left.size.width; x += kStep_px) {
      Selection arm{&kRightArm, {}};
      for (const JointDef& joint : kRightArm.joints)
        arm.clicks.push_back({joint.id, static_cast<double>(x), static_cast<double>(y)});
      selected = tracker->select(frame, {&arm, 1});
      if (selected) return tracker;
    }
  return selected.error();
}

/// As many pairs in flight as the engine takes; each frame is tracked where there is a tracker.
double frames_per_s(Engine& engine, Tracker* tracker, const Pair& pair, int frames) {
  const double begin_ms = clock_ms(CLOCK_MONOTONIC);
  int submitted = 0;
  for (int collected = 0; collected < frames; ++collected) {
    for (; submitted < std::min(frames, collected + engine.in_flight()); ++submitted) engine.submit(pair);
    const auto frame = engine.collect();
    if (tracker != nullptr) tracker->track(*frame);
  }
  return frames * 1e3 / (clock_ms(CLOCK_MONOTONIC) - begin_ms);
}

Result<DeviceRun> measure_on_device(Engine& engine, const Setup& setup, const Pair& pair, int repeat, std::string name) {
  DeviceRun run;
  run.name = std::move(name);
  DUO_TRY(engine.prepare(setup));
  const auto once = [&] {
    engine.submit(pair);
    return engine.collect();
  };
  const auto first = once();
  run.bytes_down = bytes_of(*first);
  std::unique_ptr<Tracker> tracker;
  if (setup.wants.on_device) {
    DUO_TRY_ASSIGN(tracker, tracker_on(*first, engine, *setup.rig));
  }
  run.bytes_up = 2 * bytes_of(pair.left.pixels);
  std::vector<double> cpu_ms;
  for (int i = 0; i < repeat; ++i) {
    const double wall = clock_ms(CLOCK_MONOTONIC), cpu = clock_ms(CLOCK_THREAD_CPUTIME_ID);
    const auto frame = once();
    if (tracker != nullptr) tracker->track(*frame);
    run.latency_ms.push_back(clock_ms(CLOCK_MONOTONIC) - wall);
    cpu_ms.push_back(clock_ms(CLOCK_THREAD_CPUTIME_ID) - cpu);
    add_stages(*frame, tracker != nullptr ? tracker->stages() : std::span<const StageTime>(), run);
  }
  run.own_cpu_ms = median_of(cpu_ms);
  run.frames_per_s = frames_per_s(engine, tracker.get(), pair, repeat);
  if (const std::string event = engine.take_event(); !event.empty()) return Error{ErrorCode::kDeviceLost, event};
  return run;
}

nlohmann::json bench_json(const DeviceRun& run) {
  nlohmann::json stages = nlohmann::json::array();
  for (const DeviceStage& stage : run.stages) stages.push_back({{"stage", stage.name}, {"gpu_ms", median_of(stage.ms)}});
  return {{"name", run.name},
          {"latency_ms", median_of(run.latency_ms)},
          {"gpu_ms", median_of(run.gpu_ms)},
          {"calling_thread_cpu_ms", run.own_cpu_ms},
          {"frames_per_s", run.frames_per_s},
          {"bytes_up", run.bytes_up},
          {"bytes_down", run.bytes_down},
          {"stages", stages}};
}

void say_run(const DeviceRun& run, const SayLine& say) {
  std::string line = fmt::format("{:<33} {:9.2f} {:9.2f} {:9.2f} {:9.1f} {:8.2f} {:8.2f}  ", run.name,
                                 median_of(run.latency_ms), median_of(run.gpu_ms), run.own_cpu_ms, run.frames_per_s,
                                 static_cast<double>(run.bytes_up) * 1e-6, static_cast<double>(run.bytes_down) * 1e-6);
  for (const DeviceStage& stage : run.stages) line += fmt::format("{} {:.2f}  ", stage.name, median_of(stage.ms));
  say(line + "\n");
}

}  // namespace

Result<std::string> bench_device(const SyntheticPair& input, const std::string& engine_name, int repeat, const SayLine& say) {
  DUO_TRY_ASSIGN(const auto engine, make_engine(engine_name, 1));
  DUO_TRY_ASSIGN(const DeviceSpeed speed, measure_device(engine->device()));
  const Size size = input.pair.left.pixels.size();
  nlohmann::json out = {{"device", engine->device()},     {"width", size.width},      {"height", size.height},
                        {"copy_gb_s", speed.copy_gb_s},   {"up_gb_s", speed.up_gb_s}, {"down_gb_s", speed.down_gb_s},
                        {"ours", nlohmann::json::array()}};
  say_format(
      say,
      "\n{}x{}, {} disparities, {}: copies {:.1f} GB/s on the device, {:.1f} up, {:.1f} down\n{:<33} {:>9} {:>9} {:>9} {:>9} "
      "{:>8} {:>8}  {}\n",
      size.width, size.height, kBenchDisparities, engine->device(), speed.copy_gb_s, speed.up_gb_s, speed.down_gb_s, "",
      "latency", "GPU ms", "CPU ms", "frames/s", "MB up", "MB down", "stages, ms");
  struct Sent {
    const char* name;
    bool maps, on_device;
  };
  for (const auto& [matcher, preset] : kBenchChoices)
    for (const auto& [sent, maps, on_device] :
         {Sent{"", false, false}, {", tracked", false, true}, {", all maps, filled", true, false}}) {
      Setup setup;
      setup.size = size;
      setup.rig = input.rig;
      setup.matcher = matcher;
      setup.preset = preset;
      setup.max_disparity = kBenchDisparities;
      setup.fill = maps;  // on the CPU, so not of frames that stay on the device
      setup.wants = {
          .color = maps, .depth = maps, .confidence = false, .views = maps, .disparity = maps, .on_device = on_device};
      setup.time_stages = true;
      DUO_TRY_ASSIGN(const DeviceRun run,
                     measure_on_device(*engine, setup, input.pair, repeat, fmt::format("{} {}{}", matcher, preset, sent)));
      out["ours"].push_back(bench_json(run));
      say_run(run, say);
    }
  return json_text(out, -1);
}

}  // namespace duo
