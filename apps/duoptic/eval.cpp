// duoptic eval: eval clip has its own file; here eval middlebury, our accuracy on scenes with known truth, beside OpenCV's
// matchers run in the same call.
#include <fmt/format.h>

#include <memory>

#include "command.h"
#include "duoptic/interrupt.h"
#include "duoptic/output_set.h"
#include "duoptic/reports.h"
#include "duoptic/sink.h"
#include "eval_clip.h"
#include "progress.h"

namespace duo::app::eval {
namespace {

constexpr char kFooter[] =
    "A scene is a folder with left.png, right.png, disp_left.png and meta.json (gt_scale, ndisp, eval_border), and the "
    "official\n"
    "masks mask_nonocc.png and mask_disc.png if there are any; DIR is a scene or a folder of scenes, and of several folders "
    "each\n"
    "has its own mean. Searches [0, ndisp).\n"
    "Numbers: bad pixels in %, at 0.5, 1 and 2 px, in the regions nonocc, all and disc of the Middlebury evaluation version "
    "2;\n"
    "filled = each hole takes the smaller of its nearest neighbours on the row; holes bad = a hole counts as wrong.\n\n"
    "Examples:\n"
    "  duoptic eval middlebury data/middlebury\n"
    "  duoptic eval middlebury data/middlebury data/middlebury_walls\n"
    "  duoptic eval middlebury teddy cones --preset thesis --no-peers --json\n"
    "  duoptic eval middlebury data/middlebury --perturb";

struct Options {
  std::vector<std::string> folders;
  std::string output;
  bool no_peers = false, perturb = false, keep_rows = false, json = false;
  EngineOptions engine;

  SceneMatcher matcher(const EngineOptions& one) const {
    return {fmt::format("duoptic {} {}", one.matcher, one.preset), one.engine, one.threads, one.setup(), keep_rows};
  }
};

/// Our fast matchers, with the one that was asked for, and OpenCV's 3WAY.
SceneContest fast_ones(const Options& options) {
  SceneContest out{.ours = {}, .threads = options.engine.threads};
  for (const std::string& name : matcher_names()) {
    if (name == "fine" && name != options.engine.matcher) continue;  // takes a hundred times as long
    EngineOptions one = options.engine;
    if (name != one.matcher) one.preset = "default", one.set.clear();
    one.matcher = name;
    out.ours.push_back(options.matcher(one));
  }
  for (const Peer& peer : accuracy_peers())
    if (peer.kind == Peer::Kind::k3Way) out.peers.push_back(peer);
  return out;
}

Result<Exit> run_perturbed(const Options& options, const CLI::App& app) {
  Interrupt::end_at_once();
  DUO_TRY_ASSIGN(const auto folders, find_scenes({options.folders.begin(), options.folders.end()}));
  std::vector<StereoScene> scenes;
  for (const auto& folder : folders) {
    DUO_TRY_ASSIGN(StereoScene scene, load_scene(folder));
    scenes.push_back(std::move(scene));
  }
  const SceneContest contest = fast_ones(options);
  const auto score = [&](const Perturbation& how) -> Result<std::vector<MethodScores>> {
    Progress progress(app, static_cast<std::int64_t>(scenes.size()), false, "scene");
    std::vector<MethodScores> out = methods_of(contest);
    for (const StereoScene& scene : scenes) {
      DUO_TRY(add_scene(contest, duo::perturb(scene, how), out, [&](double done) { progress.part(done); }));
      progress.frame(static_cast<std::int64_t>(out[0].scenes.size()));
    }
    return out;
  };
  DUO_TRY_ASSIGN(const auto clean, score({.name = "as they are"}));
  if (!options.json) fmt::print("{}", heading_of_faults(clean));
  std::vector<FaultScores> faults;
  for (const Perturbation& how : perturbations()) {
    DUO_TRY_ASSIGN(auto worse, score(how));
    faults.push_back({how.name, std::move(worse)});
    if (!options.json) fmt::print("{}", text_of(faults.back(), clean));
  }
  if (options.json) fmt::print("{}\n", json_of(faults, clean));
  return Exit::kOk;
}

Result<Exit> run(const Options& options, const CLI::App& app) {
  if (options.output.empty()) Interrupt::end_at_once();
  std::vector<SceneGroup> groups;
  DUO_TRY_ASSIGN(const auto folders, find_scenes_of(options.folders, groups));
  // Ours as asked for; then, where that leaves holes, filled by ourselves; then the peers.
  SceneContest contest{.ours = {options.matcher(options.engine)}, .threads = options.engine.threads};
  if (!options.engine.fill) {
    SceneMatcher filled = contest.ours[0];
    filled.name += ", --fill";
    filled.setup.fill = true;
    contest.ours.push_back(std::move(filled));
  }
  if (!options.no_peers) contest.peers.assign(accuracy_peers().begin(), accuracy_peers().end());
  std::vector<MethodScores> methods = methods_of(contest);
  Progress progress(app, static_cast<std::int64_t>(folders.size()), false, "scene");
  for (const auto& folder : folders) {
    if (Interrupt::asked()) return stopped("all scenes were scored");
    DUO_TRY_ASSIGN(const StereoScene scene, load_scene(folder));
    DUO_TRY_ASSIGN(const Image<float> d_px, add_scene(contest, scene, methods, [&](double done) { progress.part(done); }));
    if (!options.output.empty()) {
      DUO_TRY_ASSIGN(OutputSet out, OutputSet::open(options.output));
      DUO_TRY(write_png(draw_errors(d_px, scene), out / (scene.name + "_errors.png")));
      DUO_TRY(out.publish());
    }
    progress.frame(static_cast<std::int64_t>(methods[0].scenes.size()));
  }
  progress.end();
  fmt::print("{}", options.json ? json_of(methods, groups) + "\n" : text_of(methods, groups));
  return Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("eval", "Accuracy on scenes with known truth");
  CLI::App* middlebury = sub->add_subcommand("middlebury", "The Middlebury evaluation, version 2");
  sub->require_subcommand(1);
  const auto options = std::make_shared<Options>();
  options->engine.denoise = Denoise::kNone;
  middlebury->add_option("DIR", options->folders, "Scene, or folder of scenes")->required();
  options->engine.add_to(*middlebury);
  middlebury->add_flag("--keep-rows", options->keep_rows, "Do not put rows right that disagree, as duoptic depth does");
  middlebury->add_flag("--no-peers", options->no_peers, "Do not run OpenCV's matchers");
  middlebury->add_flag("--perturb", options->perturb,
                       "What a gain of 0.8, noise and a row error of 0.5 px add, for each matcher and OpenCV's 3WAY");
  middlebury->add_flag("--json", options->json, "Print the scores as JSON");
  middlebury->add_option("-o,--output", options->output, "Folder for pictures of the errors")->type_name("DIR");
  middlebury->footer(kFooter);
  const Command clip = eval_clip::add(*sub);
  return {sub, [options, clip, middlebury] {
            if (clip.app->parsed()) return clip.run();
            return options->perturb ? run_perturbed(*options, *middlebury) : run(*options, *middlebury);
          }};
}

}  // namespace duo::app::eval
