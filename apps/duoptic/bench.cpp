// duoptic bench: time of each stage and of whole frames, beside OpenCV's matchers in the same process on the same pair; of
// networks.
#include <fmt/format.h>
#include <hwy/targets.h>

#include <memory>

#include "command.h"
#include "duoptic/bench.h"
#include "duoptic/interrupt.h"

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
    "the\n"
    "instructions that ours may use; the ratio is its wall time by ours. \"one thread\": how many times faster than on one\n"
    "thread, in turn with it, each thread on a core of its own.\n"
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

struct Options {
  std::string what = "all", engine = "both", size = "both", instructions;
  std::vector<std::string> clips;
  int repeat = 11;
  bool fine = false, whole = false, json = false;
};

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

Result<Exit> run(const Options& options) {
  Interrupt::end_at_once();
  if (!options.instructions.empty()) DUO_TRY(limit_instructions(options.instructions));
  const std::string engine = options.engine == "both" ? "simd" : options.engine;
  nlohmann::json out = nlohmann::json::array();
  const auto say = [&options](const std::string& text) {
    if (options.json) return;
    fmt::print("{}", text);
    std::fflush(stdout);
  };
  const auto add = [&out](const std::string& table) { out.push_back(nlohmann::json::parse(table)); };
  for (const std::string& clip : options.clips) {
    DUO_TRY_ASSIGN(const std::string table, bench_clip(clip, engine, options.whole, options.repeat, say));
    add(table);
  }
  for (const Size size : {Size{640, 480}, Size{1280, 720}}) {
    if (!options.clips.empty() || options.what == "networks") break;
    if (options.size != "both" && options.size != fmt::format("{}x{}", size.width, size.height)) continue;
    const SyntheticPair input = render_synthetic({.size = size}, 2);
    if (on_device(options.engine)) {
      DUO_TRY_ASSIGN(const std::string table, bench_device(input, options.engine, options.repeat, say));
      add(table);
      continue;
    }
    for (const int threads : {1, 2}) {
      DUO_TRY_ASSIGN(const std::string table,
                     bench_frames(input, {options.engine, threads, options.repeat, options.fine}, say));
      add(table);
    }
  }
  if (options.clips.empty() && options.what != "frames") {
    DUO_TRY_ASSIGN(const std::string networks, bench_networks(engine, options.repeat, say));
    out.push_back({{"networks", nlohmann::json::parse(networks)}});
  }
  if (options.json) print_json(out);
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
