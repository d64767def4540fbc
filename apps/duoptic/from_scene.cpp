#include "from_scene.h"

#include <fmt/format.h>

#include "duoptic/interrupt.h"
#include "rig_report.h"

namespace duo::app {
namespace {

constexpr double kGuessedBaseline_m = 0.1;  // of a rig that is not metric

Result<std::optional<Rig>> read_lenses(const FromSceneOptions& options) {
  if (options.intrinsics.empty()) return std::optional<Rig>{};
  DUO_TRY_ASSIGN(Rig rig, load_rig(options.intrinsics));
  if (!rig.metric)
    return Error{ErrorCode::kBadInput,
                 fmt::format("the lenses of '{}' are a guess (it is not metric); give a rig of a board", options.intrinsics)};
  return std::optional<Rig>{std::move(rig)};
}

}  // namespace

void add_from_scene_options(CLI::App& app, FromSceneOptions& options) {
  app.add_option("--intrinsics", options.intrinsics,
                 "With --from-scene: a rig file of the same cameras, of which only the lenses are used; without it the rig is "
                 "not metric")
      ->type_name("RIG");
  app.add_option("--baseline-m", options.baseline_m, "With --from-scene: from lens to lens; without it that of --intrinsics")
      ->type_name("M")
      ->check(within(0.01, 5.0));
}

Result<Exit> run_from_scene(const FromSceneOptions& options, const CLI::App& app) {
  const bool prints = may_print(options.output, options.json);
  DUO_TRY_ASSIGN(const std::optional<Rig> lenses, read_lenses(options));
  DUO_TRY_ASSIGN(const auto pairs, open_pairs(options.left, options.right, options.input.wish()));
  const double baseline_m = options.baseline_m ? *options.baseline_m : lenses ? lenses->baseline_m() : kGuessedBaseline_m;
  DUO_TRY_ASSIGN(SceneRig found, rig_from_scene(lenses, baseline_m, *pairs, options.threads));
  if (found.after.verdict == RigVerdict::kRecalibrate)
    return Error{
        ErrorCode::kBadInput,
        fmt::format("no rig fits this scene: its rows stay {:.2f} px off{}; show a scene with texture at several distances, "
                    "or calibrate with a board",
                    found.after.row_px, lenses ? ", so the intrinsics may belong to other cameras" : "")};
  if (Interrupt::asked()) return stopped("the rig was written");
  found.rig.date = date_now();
  DUO_TRY(save_rig(found.rig, options.output));
  if (options.json) {
    const nlohmann::json out = {{"rig", to_json(found.rig)}, {"scene", to_json(found.after)}, {"file", options.output}};
    fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else if (prints) {
    fmt::print("rig      {}\n{}verdict  {}; written to {}\n", describe(found.rig), describe(found.after),
               name_of(found.after.verdict), options.output);
  }
  if (!found.rig.metric)
    say(app, "warning: without --intrinsics the rig is not metric: rows agree and nearer is nearer, but distances are a guess");
  if (!found.after.missing.empty()) say(app, "warning: no points in " + found.after.missing + "; move the rig and try again");
  if (!pairs->warning().empty()) say(app, "warning: " + pairs->warning());
  return found.after.cut ? Exit::kCut : Exit::kOk;
}

}  // namespace duo::app
