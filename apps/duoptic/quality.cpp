// duoptic quality: how good depth is, measured on a wall.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "command.h"
#include "duoptic/calibrate.h"
#include "duoptic/interrupt.h"
#include "duoptic/pipeline.h"
#include "duoptic/reports.h"
#include "input.h"
#include "progress.h"
#include "run_news.h"

namespace duo::app::quality {
namespace {

constexpr char kFooter[] =
    "Point the rig at a flat wall with texture, as squarely as you can, and hold it still. The figures are those of "
    "RealSense's\n"
    "Depth Quality Tool. Fill rate: pixels of the region with a depth. Plane-fit RMS and sub-pixel RMS: how far points lie "
    "from\n"
    "the plane that fits them best, without the nearest and the farthest 0.5 %. Temporal noise: how much the depth of a pixel\n"
    "varies from frame to frame. Z error: distance of that plane less --distance-m, measured from the left lens.\n\n"
    "Examples:\n"
    "  duoptic quality camera:0 camera:2 --rig rig.json --distance-m 1.5\n"
    "  duoptic quality left.avi right.avi --rig rig.json --region 200,150,240,180 --json";

struct Options {
  std::optional<double> distance_m;
  std::optional<Window> region;
  int frames = 40;
  InputOptions input;
  RigCheck check = RigCheck::kTell;
  double near_m = 0.5;
  bool json = false;
  EngineOptions engine;
};

Result<Exit> run(const Options& options, const CLI::App& app) {
  Interrupt::end_at_once();
  PipelineSetup setup{.engine = options.engine.engine, .threads = options.engine.threads, .check = options.check};
  setup.frames = options.engine.setup();
  DUO_TRY_ASSIGN(Input input, options.input.open());
  setup.frames.rig = input.rig;
  if (!input.rig) throw CLI::RequiredError("--rig");
  DUO_TRY_ASSIGN(setup.frames.max_disparity, disparities_from(*input.rig, options.near_m));
  DUO_TRY_ASSIGN(Pipeline pipeline, Pipeline::open(std::move(input.pairs), std::move(setup)));
  const Rectified& rectified = pipeline.header().rectified;
  const Window region = options.region ? options.region->within(rectified.size) : middle_half(rectified.size);
  if (region.empty())
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot measure in --region: it lies outside the rectified left picture, which "
                             "is {}x{}",
                             rectified.size.width, rectified.size.height)};
  DepthQualityMeter meter(rectified, region, options.distance_m);
  Progress progress(app, options.frames, options.json);
  RunNews news(app);
  int frames = 0;
  Next next = Next::kNew;
  while (frames < options.frames) {
    DUO_TRY_ASSIGN(next, pipeline.next());
    news.see(pipeline);
    if (next == Next::kNothing) continue;
    if (next != Next::kNew) break;
    DUO_TRY(meter.add(*pipeline.frame()));
    progress.frame(++frames);
  }
  if (frames == 0)
    return Error{ErrorCode::kBadInput, fmt::format("cannot measure depth: {} gave no frame", options.input.left)};
  const bool metric = pipeline.header().metric;
  const DepthQuality quality = meter.quality();
  fmt::print("{}",
             options.json ? json_of(quality, region, metric, pipeline.rig_fit()) + "\n" : text_of(quality, region, metric));
  if (const std::string warning = pipeline.warning(); !pipeline.live() && !warning.empty()) say(app, "warning: " + warning);
  return next == Next::kCut ? Exit::kCut : Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("quality", "How good depth is, measured on a flat wall");
  const auto options = std::make_shared<Options>();
  sub->add_option("LEFT", options->input.left, "Picture, video, recording or camera, the left one or both in one")->required();
  sub->add_option("RIGHT", options->input.right, "The same of the right camera");
  sub->add_option("--rig", options->input.rig, "Calibration; a recording may bring its own")->type_name("FILE");
  sub->add_option("--distance-m", options->distance_m, "From the left lens to the wall, at a right angle to it")
      ->type_name("M")
      ->check(above_zero());
  add_window_option(*sub, "--region", "Part of the rectified left picture; without it the half around its middle",
                    [options](Window window) { options->region = window; });
  sub->add_option("--frames", options->frames, "Of a video or cameras, how many")
      ->type_name("N")
      ->check(within(1, 1000))
      ->capture_default_str();
  sub->add_option("--near", options->near_m, "Searches as far as something at this distance needs, by the rig")
      ->type_name("METRES")
      ->check(above_zero())
      ->capture_default_str();
  options->input.add_to(*sub);
  add_strict_option(*sub, options->check);
  options->engine.add_to(*sub);
  sub->add_flag("--json", options->json, "Print the figures as JSON");
  sub->footer(kFooter);
  return {sub, [options, sub] { return run(*options, *sub); }};
}

}  // namespace duo::app::quality
