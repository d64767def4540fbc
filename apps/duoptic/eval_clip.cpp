// duoptic eval clip: the tracker against clips with exact joints and depth.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "duoptic/interrupt.h"
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

template <class T>
nlohmann::json or_null(const std::optional<T>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

nlohmann::json to_json(const ClipScore& score) {
  nlohmann::json joints = nlohmann::json::object();
  for (const auto& [id, s] : score.joints)
    joints[std::string(name_of(id))] = {{"median_mm", or_null(s.median_mm)},
                                        {"p95_mm", or_null(s.p95_mm)},
                                        {"lost_or_off_percent", or_null(s.bad_percent)},
                                        {"frames_to_recover", or_null(s.frames_to_recover)},
                                        {"recovered", s.recovered},
                                        {"hidden_median_mm", or_null(s.hidden_median_mm)},
                                        {"hidden_lost_percent", or_null(s.hidden_lost_percent)},
                                        {"hidden_false_percent", or_null(s.hidden_false_percent)},
                                        {"inside_3_sigma_percent", or_null(s.inside_3_sigma_percent)}};
  nlohmann::json out = {{"clip", score.clip},         {"tracker", score.tracker},
                        {"first_frame", score.first}, {"frames", score.frames},
                        {"left_out", score.left_out}, {"fps", score.fps},
                        {"joints", joints},           {"depth", nullptr},
                        {"people", score.people},     {"identity_switches", score.identity_switches}};
  if (const auto& d = score.depth)
    out["depth"] = {{"coverage_percent", d->coverage_percent},
                    {"bad_percent", d->bad_percent},
                    {"median_px", d->median_px},
                    {"median_depth_percent", d->median_depth_percent},
                    {"bias_px", d->bias_px},
                    {"background_bias_px", d->background_bias_px}};
  return out;
}

std::string cell(const std::optional<double>& value, int digits, const char* unit) {
  return value ? fmt::format("{:.{}f}{}", *value, digits, unit) : "-";
}

void print_lines(const ClipScore& score) {
  for (const auto& [id, s] : score.joints) {
    const bool first = id == score.joints[0].first;
    const std::string recover =
        s.frames_to_recover ? fmt::format("{}{}", s.recovered ? "" : ">", *s.frames_to_recover) : std::string("-");
    fmt::print("{:<18} {:<8} {:<14} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n", first ? score.clip : "",
               first ? score.tracker : "", name_of(id), cell(s.median_mm, 1, ""), cell(s.p95_mm, 1, ""),
               cell(s.bad_percent, 1, "%"), recover, cell(s.hidden_median_mm, 1, ""), cell(s.hidden_lost_percent, 1, "%"),
               cell(s.hidden_false_percent, 1, "%"), cell(s.inside_3_sigma_percent, 1, "%"));
  }
  fmt::print("{:<27} {} frames from {}, {:.1f} frames/s", "", score.frames, score.first, score.fps);
  if (score.left_out > 0) fmt::print(", {} without a pair left out", score.left_out);
  if (score.people > 1) fmt::print(", {} people, {} identity switches", score.people, score.identity_switches);
  if (score.depth)
    fmt::print(
        "; depth on the person: {:.1f} % covered, {:.1f} % off by more than 1 px, median {:.2f} px = {:.2f} %, "
        "bias {:+.3f} px, on the background {:+.3f} px",
        score.depth->coverage_percent, score.depth->bad_percent, score.depth->median_px, score.depth->median_depth_percent,
        score.depth->bias_px, score.depth->background_bias_px);
  fmt::print("\n");
}

}  // namespace

Result<PipelineSetup> setup_of(const TrackingOptions& tracking, const std::filesystem::path& clip, const Rig& rig) {
  TrackingOptions all = tracking;
  all.all_maps = true;
  return all.setup({nullptr, rig, {(clip / "left.avi").string(), (clip / "right.avi").string()}});
}

void print(const std::vector<ClipScore>& scores) {
  fmt::print("{:<18} {:<8} {:<14} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n", "clip", "tracker", "joint", "median",
             "p95", "bad", "recover", "hidden", "h.lost", "h.false", "3 sigma");
  for (const ClipScore& score : scores) print_lines(score);
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
  if (options.json) {
    nlohmann::json out = {
        {"bad_mm", kBadJoint_mm}, {"jitter_px", options.jitter_px}, {"rig", options.rig}, {"clips", nlohmann::json::array()}};
    for (const ClipScore& score : scores) out["clips"].push_back(to_json(score));
    fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return Exit::kOk;
  }
  print(scores);
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
