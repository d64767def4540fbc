// duoptic synth: a person in a room, rendered with the truth of every joint.
#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <thread>

#include "command.h"
#include "duoptic/interrupt.h"
#include "duoptic/synthetic.h"
#include "progress.h"

namespace duo::app::synth {
namespace {

constexpr char kFooter[] =
    "Writes into DIR: left.avi and right.avi (MJPEG, 30 frames/s, two distorted, noisy webcams), calibration_truth.yml,\n"
    "truth.json (joints of every frame in the raw left camera), and every tenth frame depth/depth_NNNN.png (16 bits, 0.1 mm)\n"
    "with the person's mask depth/figure_NNNN.png. DIR appears when all is done; an earlier clip there is replaced.\n\n"
    "wave, reach, sweep, behind, out and light move one arm, tour does all of these. turn, walk, sit and cross move whole "
    "bodies\n"
    "of several sizes, farther away; in cross a second person comes the other way (its joints: frames[i].others).\n\n"
    "With --skew-ms the right pictures show a later moment, as those of webcams that are not in step do; truth.json tells.\n\n"
    "Example:\n"
    "  duoptic synth --script behind --seed 2 -o clip\n"
    "  duoptic synth --script cross --seed 3 -o two\n"
    "  duoptic synth --script wave --skew-ms 16 -o late\n"
    "  duoptic eval clip clip";

const std::map<std::string, SyntheticArm> kArms = {
    {"auto", SyntheticArm::kBySeed}, {"left", SyntheticArm::kLeft}, {"right", SyntheticArm::kRight}};

struct Options {
  SyntheticClipSetup clip;
  std::string arm = "auto", folder;
  int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  double skew_ms = 0;
  bool quiet = false;
};

Result<Exit> run(const Options& options, const CLI::App& app) {
  const auto start = std::chrono::steady_clock::now();
  if (!options.quiet) say(app, "preparing the room ...");
  std::unique_ptr<Progress> progress;  // its end clears the line
  int frames = 0;
  DUO_TRY(write_clip(options.clip, options.folder, options.threads, [&](int done, int all) {
    if (!progress) progress = std::make_unique<Progress>(app, all, options.quiet);
    progress->frame(done);
    frames = done;
    return !Interrupt::asked();
  }));
  progress.reset();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  fmt::print("{}: {} frames of '{}', {}x{}, seed {}, in {:.1f} s\n", options.folder, frames, options.clip.script,
             options.clip.size.width, options.clip.size.height, options.clip.seed, took.count());
  return Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("synth", "Render a person in a room: two webcams' videos with exact truth");
  const auto options = std::make_shared<Options>();
  sub->add_option("--script", options->clip.script,
                  fmt::format("What the person does: {}", fmt::join(synthetic_scripts(), ", ")))
      ->check(CLI::IsMember(synthetic_scripts()))
      ->capture_default_str();
  sub->add_option("--frames", options->clip.frames, "How many, 30 a second; 0: the script once")
      ->check(within(0, 100000))
      ->capture_default_str();
  add_size_option(*sub, options->clip.size, "Of one picture")->default_str("640x480");
  sub->add_option("--seed", options->clip.seed, "Person, clothes, room, rig and noise")->capture_default_str();
  sub->add_option("--arm", options->arm, "The person's own left or right; auto: by the seed")
      ->check(CLI::IsMember({"auto", "left", "right"}))
      ->capture_default_str();
  sub->add_option("--skew-ms", options->skew_ms, "How much later than the left one the right camera takes its pictures")
      ->type_name("MS")
      ->check(within(-100.0, 100.0))
      ->capture_default_str();
  sub->add_option("--threads", options->threads, "Threads; the result does not depend on them")
      ->check(within(1, 256))
      ->capture_default_str();
  sub->add_flag("--quiet", options->quiet, "No progress on stderr");
  sub->add_option("-o,--output", options->folder, "Folder for the clip")->type_name("DIR")->required();
  sub->parse_complete_callback([options] {
    options->clip.arm = kArms.at(options->arm);
    options->clip.skew_s = options->skew_ms * 1e-3;
  });
  sub->footer(kFooter);
  return {sub, [options, sub] { return run(*options, *sub); }};
}

}  // namespace duo::app::synth
