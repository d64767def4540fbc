// duoptic quality: how good depth is, measured on a wall.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "command.h"
#include "duoptic/calibrate.h"
#include "duoptic/depth_quality.h"
#include "duoptic/interrupt.h"
#include "duoptic/pipeline.h"
#include "input.h"
#include "live_news.h"
#include "progress.h"
#include "rig_report.h"

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
  std::string left, right, rig;
  std::optional<double> distance_m;
  std::optional<Window> region;
  int frames = 40;
  InputOptions input;
  RigCheck check = RigCheck::kTell;
  double near_m = 0.5;
  bool json = false;
  EngineOptions engine;
};

void print(const DepthQuality& q, Window region, const Pipeline& pipeline, const Options& options) {
  const bool metric = pipeline.header().metric;
  if (options.json) {
    nlohmann::json out = {{"frames", q.frames},
                          {"region", {region.x, region.y, region.width, region.height}},
                          {"metric", metric},
                          {"fill_rate_percent", q.fill_rate_percent},
                          {"distance_m", q.distance_m},
                          {"angle_deg", q.angle_deg},
                          {"plane_fit_rms_mm", q.plane_fit_rms_mm},
                          {"subpixel_rms_px", q.subpixel_rms_px},
                          {"temporal_noise_mm", nullptr},
                          {"temporal_noise_percent", nullptr},
                          {"z_error_mm", nullptr},
                          {"z_accuracy_percent", nullptr},
                          {"rig_fit", to_json(pipeline.rig_fit())}};
    if (q.frames > 1) out["temporal_noise_mm"] = q.temporal_noise_mm, out["temporal_noise_percent"] = q.temporal_noise_percent;
    if (q.z_error_mm) out["z_error_mm"] = *q.z_error_mm, out["z_accuracy_percent"] = *q.z_accuracy_percent;
    fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return;
  }
  const char *m = metric ? "m" : "units", *mm = metric ? "mm" : "thousandths";
  fmt::print("region          {}x{} px at {},{}, {} frame{}\n", region.width, region.height, region.x, region.y, q.frames,
             q.frames == 1 ? "" : "s");
  fmt::print("wall            {:.3f} {} away, turned by {:.1f} degrees\n", q.distance_m, m, q.angle_deg);
  fmt::print("fill rate       {:.1f} %\n", q.fill_rate_percent);
  fmt::print("plane-fit RMS   {:.2f} {}\n", q.plane_fit_rms_mm, mm);
  fmt::print("sub-pixel RMS   {:.3f} px\n", q.subpixel_rms_px);
  if (q.frames > 1) fmt::print("temporal noise  {:.2f} {} = {:.3f} %\n", q.temporal_noise_mm, mm, q.temporal_noise_percent);
  if (q.z_error_mm) fmt::print("z error         {:+.1f} {} = {:+.2f} %\n", *q.z_error_mm, mm, *q.z_accuracy_percent);
}

Result<Exit> run(const Options& options, const CLI::App& app) {
  Interrupt::end_at_once();
  PipelineSetup setup{.engine = options.engine.engine, .threads = options.engine.threads, .check = options.check};
  setup.frames = options.engine.setup();
  if (!options.rig.empty()) {
    DUO_TRY_ASSIGN(setup.frames.rig, load_rig(options.rig));
  }
  DUO_TRY_ASSIGN(Input input, open_input(options.left, options.right, setup.frames.rig, options.input));
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
  LiveNews live(app);
  int frames = 0;
  Next next = Next::kNew;
  while (frames < options.frames) {
    DUO_TRY_ASSIGN(next, pipeline.next());
    say_rig_news(app, pipeline);
    live.see(pipeline);
    if (next == Next::kNothing) continue;
    if (next != Next::kNew) break;
    DUO_TRY(meter.add(*pipeline.frame()));
    progress.frame(++frames);
  }
  if (frames == 0) return Error{ErrorCode::kBadInput, fmt::format("cannot measure depth: {} gave no frame", options.left)};
  print(meter.quality(), region, pipeline, options);
  if (const std::string warning = pipeline.warning(); !pipeline.live() && !warning.empty()) say(app, "warning: " + warning);
  return next == Next::kCut ? Exit::kCut : Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("quality", "How good depth is, measured on a flat wall");
  const auto options = std::make_shared<Options>();
  sub->add_option("LEFT", options->left, "Picture, video, recording or camera, the left one or both in one")->required();
  sub->add_option("RIGHT", options->right, "The same of the right camera");
  sub->add_option("--rig", options->rig, "Calibration; a recording may bring its own")->type_name("FILE");
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
