// duoptic eval clip: the tracker against clips with exact joints and depth.
#include <fmt/format.h>

#include <memory>

#include "duoptic/interrupt.h"
#include "duoptic/reports.h"
#include "eval_clip.h"
#include "input.h"

namespace duo::app::eval_clip {
namespace {

constexpr char kFooter[] =
    "A clip is a folder with left.avi, right.avi, calibration_truth.yml and truth.json, perhaps depth/. People are found by\n"
    "themselves; trackers of arms (--tracker arm) get clicks: the truth at the first frame that shows all clicked joints to\n"
    "both cameras; scores are of the frames from there on.\n"
    "median, p95: error in mm where the joint is visible; bad: of these frames, lost or off by more than 100 mm; recover: the\n"
    "most frames from coming out after 5 or more hidden ones to being tracked again (> at the end still not); hidden, h.lost:\n"
    "median error and share lost while hidden inside the picture; h.false: share called seen while hidden and off by more "
    "than\n"
    "100 mm; 3 sigma: share of seen and inferred positions inside what the tracker claims. Of several people the joints are "
    "the\n"
    "first one's; identity switches are counted over all. With --rig joints and depth are found with that rig and compared in "
    "its left\n"
    "camera's axes with the truth, which is in the true left camera's: what a wrong rig does to distances counts as error.\n"
    "Depth is judged as disparity of that rig.\n\n"
    "Examples:\n"
    "  duoptic eval clip data/sequences/dev_easy_wave\n"
    "  duoptic eval clip clips/* --compare --json\n"
    "  duoptic eval clip data/sequences/dev_easy_wave --joints left_hand,right_hand\n"
    "  duoptic eval clip data/sequences/dev_easy_wave --rig rig.json";

struct Options {
  std::vector<std::string> folders;
  std::string rig;  // empty: each clip's true one
  std::vector<std::string> joints;
  double jitter_px = 0;
  bool compare = false, json = false;
  TrackingOptions tracking;
};

}  // namespace

Result<PipelineSetup> setup_of(const TrackingOptions& tracking, const std::filesystem::path& clip, const Rig& rig) {
  TrackingOptions all = tracking;
  all.all_maps = true;
  return all.setup({nullptr, rig, {(clip / "left.avi").string(), (clip / "right.avi").string()}});
}

namespace {

Result<Exit> run(const Options& options) {
  Interrupt::end_at_once();
  std::vector<ClipScore> scores;
  std::vector<JointId> joints;
  for (const std::string& name : options.joints) {
    const auto joint = joint_named(name);
    if (!joint) throw CLI::ValidationError("--joints", fmt::format("no joint is called '{}'; one is left_hand", name));
    joints.push_back(*joint);
  }
  for (const std::string& folder : options.folders) {
    DUO_TRY_ASSIGN(const ClipTruth truth, load_clip(folder));
    Rig rig = truth.rig;
    if (!options.rig.empty()) {
      DUO_TRY_ASSIGN(rig, load_rig(options.rig));
    }
    TrackingOptions tracking = options.tracking.or_tracker("body");
    std::vector<std::string> trackers = {tracking.tracker};
    if (options.compare) {
      trackers = tracker_names();
      const std::string_view twin = options.tracking.hands ? "body" : "body_hands";  // finds the same people
      std::erase(trackers, twin);
    }
    for (const std::string& tracker : trackers) {
      tracking.tracker = tracker;
      DUO_TRY_ASSIGN(PipelineSetup setup, setup_of(tracking, folder, rig));
      DUO_TRY_ASSIGN(ClipScore score, score_clip(folder, truth, {std::move(setup), joints, options.jitter_px}));
      scores.push_back(std::move(score));
    }
  }
  fmt::print("{}", options.json ? json_of(scores, options.jitter_px, options.rig) + "\n" : text_of(scores));
  return Exit::kOk;
}

}  // namespace

Command add(CLI::App& eval) {
  CLI::App* sub = eval.add_subcommand("clip", "The tracker on clips with exact joints and depth");
  const auto options = std::make_shared<Options>();
  sub->add_option("DIR", options->folders, "Folder of a clip")->required();
  sub->add_option("--rig", options->rig, "Tracks with this rig in place of the clips' true one")->type_name("FILE");
  options->tracking.add_to(*sub);
  sub->add_option("--joints", options->joints, "The joints to score, by name; without it those of the arm that moves")
      ->type_name("NAME,NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  sub->add_option("--jitter", options->jitter_px, "Moves each click by PX, as a hand would")
      ->type_name("PX")
      ->check(within(0.0, 1000.0));
  sub->add_flag("--compare", options->compare, "Every tracker, one after the other");
  sub->add_flag("--json", options->json, "Print the scores as JSON");
  sub->footer(kFooter);
  return {sub, [options] { return run(*options); }};
}

}  // namespace duo::app::eval_clip
