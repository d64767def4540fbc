// duoptic eval: eval clip has its own file; here eval middlebury, our accuracy on scenes with known truth, beside OpenCV's
// matchers run in the same call.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "command.h"
#include "duoptic/interrupt.h"
#include "duoptic/output_set.h"
#include "duoptic/peers.h"
#include "duoptic/sink.h"
#include "eval_clip.h"
#include "progress.h"
#include "timing.h"

namespace duo::app::eval {
namespace {

namespace fs = std::filesystem;

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

// The thesis's own table: bad-1.0, per cent, nonocc / all / disc.
const std::map<std::string, std::array<double, 3>> kThesis = {{"tsukuba", {33.2, 32.4, 27.6}},
                                                              {"venus", {32.3, 32.3, 26.0}},
                                                              {"teddy", {34.7, 34.6, 34.7}},
                                                              {"cones", {34.4, 34.3, 33.8}}};
constexpr double kThesisMean = 32.5;

struct Options {
  std::vector<std::string> folders;
  std::string output;
  bool no_peers = false, perturb = false, keep_rows = false, json = false;
  EngineOptions engine;
};

struct SceneScore {
  std::string scene;
  DisparityScore score;
  double ms = 0;
};
struct MethodScores {
  std::string method;
  std::vector<SceneScore> scenes;
};

Result<Image<float>> match(const StereoScene& scene, const EngineOptions& options, bool keep_rows, Progress& progress,
                           double& ms) {
  DUO_TRY_ASSIGN(const auto engine, make_engine(options.engine, options.threads));
  Setup setup = options.setup();
  setup.progress = [&progress](double done) { progress.part(done); };
  setup.size = scene.pair.left.pixels.size();
  setup.max_disparity = scene.max_disparity;
  if (!keep_rows) {
    const RowOffsets rows = find_row_offsets(scene.pair, options.threads);
    if (rows.matter()) setup.rows = rows;
  }
  DUO_TRY(engine->prepare(setup));
  std::shared_ptr<const Frame> frame;
  const auto once = [&] {
    engine->submit(scene.pair);
    frame = engine->collect();
  };
  once();  // warm caches
  ms = timed(once).wall_ms;
  return disparity_as_px(frame->disparity.d_q4);
}

SceneScore score_peer(const Peer& peer, const StereoScene& scene, int threads) {
  PeerMatcher matcher(peer, opencv_gray(scene.pair.left.pixels), opencv_gray(scene.pair.right.pixels), scene.max_disparity);
  matcher.run(threads);
  const double ms = timed([&] { matcher.run(threads); }).wall_ms;
  return {scene.name, score_disparity(matcher.disparity_px(), scene), ms};
}

/// Right within 1 px: gray by its error; wrong in a seen region: red; wrong where occluded: blue; hole: black.
Image<Rgb8> draw_errors(const Image<float>& d_px, const StereoScene& scene) {
  Image<Rgb8> out(d_px.size());
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      if (scene.regions.all.at(y, x) == 0) out.at(y, x) = {64, 64, 96};
      if (scene.regions.all.at(y, x) == 0 || d_px.at(y, x) < 0) continue;
      const float error = std::abs(d_px.at(y, x) - scene.truth_px.at(y, x));
      const auto gray = static_cast<std::uint8_t>(255 - 100 * std::min(error, 1.0f));
      const Rgb8 wrong = scene.regions.nonocc.at(y, x) != 0 ? Rgb8{220, 40, 40} : Rgb8{60, 90, 220};
      out.at(y, x) = error <= 1.0f ? Rgb8{gray, gray, gray} : wrong;
    }
  return out;
}

using Percent = const BadPercent& (*)(const DisparityScore&);
const BadPercent& filled(const DisparityScore& s) { return s.bad_filled; }
const BadPercent& holes_bad(const DisparityScore& s) { return s.bad_holes; }

/// Mean over scenes and regions at one threshold; over the four scenes of version 2 it is that evaluation's mean.
double mean(const MethodScores& method, Percent percent, std::size_t threshold) {
  double sum = 0;
  for (const SceneScore& s : method.scenes)
    for (double p : percent(s.score)[threshold]) sum += p;
  return sum / static_cast<double>(3 * method.scenes.size());
}

MethodScores v2_scenes(const MethodScores& method) {
  MethodScores out{method.method, {}};
  for (const SceneScore& s : method.scenes)
    if (kThesis.contains(s.scene)) out.scenes.push_back(s);
  return out;
}

bool has_v2(const MethodScores& method) {
  std::set<std::string> names;
  for (const SceneScore& s : v2_scenes(method).scenes) names.insert(s.scene);
  return names.size() == kThesis.size() && v2_scenes(method).scenes.size() == kThesis.size();
}

/// By threshold.
nlohmann::json means_of(const MethodScores& method) {
  nlohmann::json out = {{"bad_filled_percent", nlohmann::json::array()}, {"bad_holes_percent", nlohmann::json::array()}};
  for (std::size_t t = 0; t < kBadThresholds_px.size(); ++t) {
    out["bad_filled_percent"].push_back(mean(method, filled, t));
    out["bad_holes_percent"].push_back(mean(method, holes_bad, t));
  }
  return out;
}

nlohmann::json to_json(const MethodScores& method) {
  nlohmann::json scenes = nlohmann::json::array();
  for (const SceneScore& s : method.scenes)
    scenes.push_back({{"scene", s.scene},
                      {"bad_filled_percent", s.score.bad_filled},
                      {"bad_holes_percent", s.score.bad_holes},
                      {"average_error_px", s.score.average_error_px},
                      {"coverage_percent", s.score.coverage_percent},
                      {"ms", s.ms}});
  nlohmann::json out = {{"method", method.method}, {"scenes", scenes}};
  out["mean"] = means_of(method);
  if (has_v2(method)) out["v2_mean"] = means_of(v2_scenes(method));
  return out;
}

void print_ours(const MethodScores& ours) {
  fmt::print("{}: bad pixels in %, nonocc / all / disc\n", ours.method);
  fmt::print("{:<10}  {:^19}  {:^19}  {:^19}  {:^19}  {:>7}  {:>8}  {:>6}\n", "scene", "bad-1.0 filled", "bad-1.0 holes bad",
             "bad-0.5 filled", "bad-2.0 filled", "avg px", "coverage", "ms");
  const auto cell = [](const std::array<double, 3>& p) { return fmt::format("{:5.1f}  {:5.1f}  {:5.1f}", p[0], p[1], p[2]); };
  for (const SceneScore& s : ours.scenes)
    fmt::print("{:<10}  {}  {}  {}  {}  {:7.2f}  {:7.1f}%  {:6.1f}\n", s.scene, cell(s.score.bad_filled[1]),
               cell(s.score.bad_holes[1]), cell(s.score.bad_filled[0]), cell(s.score.bad_filled[2]), s.score.average_error_px,
               s.score.coverage_percent, s.ms);
}

void print_means(const std::vector<MethodScores>& methods, const std::string& of) {
  fmt::print("\nMean over {} (nonocc, all and disc of each scene):\n{:<28} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", of, "",
             "1 filled", "1 holes", ".5 filled", ".5 holes", "2 filled", "2 holes");
  for (const MethodScores& m : methods)
    fmt::print("{:<28} {:9.2f} {:9.2f} {:9.2f} {:9.2f} {:9.2f} {:9.2f}\n", m.method, mean(m, filled, 1), mean(m, holes_bad, 1),
               mean(m, filled, 0), mean(m, holes_bad, 0), mean(m, filled, 2), mean(m, holes_bad, 2));
}

void print_v2_means(const std::vector<MethodScores>& methods) {
  std::vector<MethodScores> of_v2;
  for (const MethodScores& m : methods) of_v2.push_back(v2_scenes(m));
  print_means(of_v2, "tsukuba, venus, teddy, cones: the version-2 mean");
  fmt::print("{:<28} {:9.2f}   as printed there:", "thesis of 2010", kThesisMean);
  for (const auto& [scene, p] : kThesis) fmt::print(" {} {:.1f} {:.1f} {:.1f}", scene, p[0], p[1], p[2]);
  fmt::print("\n\"tuned\" is the best of a grid search on these four scenes; it flatters OpenCV.\n");
}

/// Our fast matchers, with the one that was asked for, and OpenCV's 3WAY on the scenes with one fault; scores in the order of
/// `names`.
struct Contest {
  std::vector<EngineOptions> ours;
  std::vector<Peer> peers;
  std::vector<std::string> names;
  bool keep_rows = false;
};

Contest contest(const Options& all) {
  const EngineOptions& options = all.engine;
  Contest out;
  out.keep_rows = all.keep_rows;
  for (const std::string& matcher : matcher_names()) {
    if (matcher == "fine" && matcher != options.matcher) continue;  // takes a hundred times as long
    EngineOptions one = options;
    if (matcher != options.matcher) one.preset = "default", one.set.clear();
    one.matcher = matcher;
    out.ours.push_back(one);
    out.names.push_back(fmt::format("duoptic {} {}", one.matcher, one.preset));
  }
  for (const Peer& peer : accuracy_peers())
    if (peer.kind == Peer::Kind::k3Way) out.peers.push_back(peer), out.names.push_back(fmt::format("OpenCV {}", peer.name));
  return out;
}

Result<std::vector<MethodScores>> score_contest(const Contest& contest, const std::vector<StereoScene>& scenes,
                                                const Perturbation& how, const CLI::App& app) {
  Progress progress(app, static_cast<std::int64_t>(scenes.size()), false, "scene");
  std::vector<MethodScores> out;
  for (const std::string& name : contest.names) out.push_back({name, {}});
  for (const StereoScene& scene : scenes) {
    StereoScene worse{scene.name, perturb(scene.pair, how), scene.max_disparity, scene.truth_px.clone(), {}};
    worse.regions = {scene.regions.all.clone(), scene.regions.nonocc.clone(), scene.regions.disc.clone()};
    for (std::size_t i = 0; i < contest.ours.size(); ++i) {
      double ms = 0;
      DUO_TRY_ASSIGN(const Image<float> d_px, match(worse, contest.ours[i], contest.keep_rows, progress, ms));
      out[i].scenes.push_back({scene.name, score_disparity(d_px, worse), ms});
    }
    for (std::size_t i = 0; i < contest.peers.size(); ++i)
      out[contest.ours.size() + i].scenes.push_back(score_peer(contest.peers[i], worse, contest.ours[0].threads));
    progress.frame(static_cast<std::int64_t>(out[0].scenes.size()));
  }
  return out;
}

Result<Exit> run_perturbed(const Options& options, const CLI::App& app) {
  Interrupt::end_at_once();
  DUO_TRY_ASSIGN(const auto folders, find_scenes({options.folders.begin(), options.folders.end()}));
  std::vector<StereoScene> scenes;
  for (const fs::path& folder : folders) {
    DUO_TRY_ASSIGN(StereoScene scene, load_scene(folder));
    scenes.push_back(std::move(scene));
  }
  const Contest all = contest(options);
  DUO_TRY_ASSIGN(const auto clean, score_contest(all, scenes, {.name = "as they are"}, app));
  nlohmann::json rows = nlohmann::json::array();
  if (!options.json) {
    fmt::print(
        "Bad-1.0 in %, holes filled by the scorer / holes bad, mean over all scenes and regions; with a fault: what is "
        "added\n{:<16}",
        "");
    for (const std::string& name : all.names) fmt::print(" {:>24}", name);
    fmt::print("\n{:<16}", "as they are");
    for (const MethodScores& m : clean)
      fmt::print(" {:>24}", fmt::format("{:.2f} / {:.2f}", mean(m, filled, 1), mean(m, holes_bad, 1)));
    fmt::print("\n");
  }
  for (const Perturbation& how : perturbations()) {
    DUO_TRY_ASSIGN(const auto worse, score_contest(all, scenes, how, app));
    nlohmann::json row = {{"fault", how.name}, {"methods", nlohmann::json::array()}};
    if (!options.json) fmt::print("{:<16}", how.name);
    for (std::size_t i = 0; i < worse.size(); ++i) {
      const double more_filled = mean(worse[i], filled, 1) - mean(clean[i], filled, 1);
      const double more_holes = mean(worse[i], holes_bad, 1) - mean(clean[i], holes_bad, 1);
      row["methods"].push_back(
          {{"method", worse[i].method}, {"added_filled_percent", more_filled}, {"added_holes_percent", more_holes}});
      if (!options.json) fmt::print(" {:>24}", fmt::format("{:+.2f} / {:+.2f}", more_filled, more_holes));
    }
    rows.push_back(row);
    if (!options.json) fmt::print("\n");
  }
  if (options.json) {
    nlohmann::json base = nlohmann::json::array();
    for (const MethodScores& m : clean) base.push_back(to_json(m));
    fmt::print("{}\n", nlohmann::json{{"clean", base}, {"perturbed", rows}}.dump(2));
  }
  return Exit::kOk;
}

/// Scenes of one folder that was named, among several.
struct Folder {
  std::string name;
  std::size_t begin = 0, end = 0;
  MethodScores of(const MethodScores& all) const {
    const auto at = [&](std::size_t i) { return all.scenes.begin() + static_cast<std::ptrdiff_t>(i); };
    return {all.method, {at(begin), at(end)}};
  }
};

/// All scenes in their order; in `groups` the folders that hold several, where there are others beside them.
///
/// Errors  those of find_scenes()
Result<std::vector<fs::path>> find_scenes_of(const std::vector<std::string>& names, std::vector<Folder>& groups) {
  std::vector<fs::path> all;
  for (const std::string& name : names) {
    DUO_TRY_ASSIGN(const auto found, find_scenes({fs::path(name)}));
    if (found.size() > 1)
      groups.push_back({fs::weakly_canonical(name).filename().string(), all.size(), all.size() + found.size()});
    all.insert(all.end(), found.begin(), found.end());
  }
  if (names.size() == 1) groups.clear();
  return all;
}

Result<Exit> run(const Options& options, const CLI::App& app) {
  if (options.output.empty()) Interrupt::end_at_once();
  std::vector<Folder> groups;
  DUO_TRY_ASSIGN(const auto folders, find_scenes_of(options.folders, groups));
  // Ours as asked for; then, where that leaves holes, filled by ourselves; then the peers.
  std::vector<EngineOptions> ours = {options.engine};
  if (!options.engine.fill) ours.push_back(options.engine), ours.back().fill = true;
  std::vector<MethodScores> methods = {{fmt::format("duoptic {} {}", options.engine.matcher, options.engine.preset), {}}};
  if (ours.size() > 1) methods.push_back({methods[0].method + ", --fill", {}});
  const std::size_t first_peer = methods.size();
  if (!options.no_peers)
    for (const Peer& peer : accuracy_peers()) methods.push_back({fmt::format("OpenCV {}", peer.name), {}});
  Progress progress(app, static_cast<std::int64_t>(folders.size()), false, "scene");
  for (const fs::path& folder : folders) {
    if (Interrupt::asked()) return stopped("all scenes were scored");
    DUO_TRY_ASSIGN(const StereoScene scene, load_scene(folder));
    std::vector<Image<float>> d_px;
    for (std::size_t i = 0; i < ours.size(); ++i) {
      double ms = 0;
      DUO_TRY_ASSIGN(Image<float> found, match(scene, ours[i], options.keep_rows, progress, ms));
      methods[i].scenes.push_back({scene.name, score_disparity(found, scene), ms});
      d_px.push_back(std::move(found));
    }
    for (std::size_t i = first_peer; i < methods.size(); ++i)
      methods[i].scenes.push_back(score_peer(accuracy_peers()[i - first_peer], scene, options.engine.threads));
    if (!options.output.empty()) {
      DUO_TRY_ASSIGN(OutputSet out, OutputSet::open(options.output));
      DUO_TRY(write_png(draw_errors(d_px[0], scene), out / (scene.name + "_errors.png")));
      DUO_TRY(out.publish());
    }
    progress.frame(static_cast<std::int64_t>(methods[0].scenes.size()));
  }
  progress.end();
  const bool v2 = has_v2(methods[0]);
  if (options.json) {
    nlohmann::json out = {
        {"thresholds_px", kBadThresholds_px}, {"regions", {"nonocc", "all", "disc"}}, {"methods", nlohmann::json::array()}};
    for (const MethodScores& m : methods) out["methods"].push_back(to_json(m));
    if (v2) out["thesis_v2_mean_percent"] = kThesisMean;
    for (const Folder& group : groups) {
      nlohmann::json of_methods = nlohmann::json::array();
      for (const MethodScores& m : methods) of_methods.push_back({{"method", m.method}, {"mean", means_of(group.of(m))}});
      out["folders"].push_back({{"folder", group.name}, {"methods", of_methods}});
    }
    fmt::print("{}\n", out.dump(2));
    return Exit::kOk;
  }
  print_ours(methods[0]);
  if (v2) print_v2_means(methods);
  for (const Folder& group : groups) {
    std::vector<MethodScores> of_group;
    for (const MethodScores& m : methods) of_group.push_back(group.of(m));
    print_means(of_group, "the scenes of " + group.name);
  }
  if (!v2 || methods[0].scenes.size() > kThesis.size()) print_means(methods, "all scenes");
  return Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("eval", "Accuracy on scenes with known truth");
  CLI::App* middlebury = sub->add_subcommand("middlebury", "The Middlebury evaluation, version 2");
  sub->require_subcommand(1);
  const auto options = std::make_shared<Options>();
  options->engine.denoise = "none";
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
