// duoptic eval clip: the tracker against clips with exact joints and depth.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "eval_clip.h"
#include "selection.h"
#include "timing.h"

namespace duo::app::eval_clip {
namespace {

namespace fs = std::filesystem;

constexpr char kFooter[] =
    "A clip is a folder with left.avi, right.avi, calibration_truth.yml and truth.json, perhaps depth/. The clicks are the "
    "truth\n"
    "at the first frame that shows all clicked joints to both cameras; scores are of the frames from there on.\n"
    "median, p95: error in mm where the joint is visible; bad: of these frames, lost or off by more than 100 mm; recover: the\n"
    "most frames from coming out after 5 or more hidden ones to being tracked again (> at the end still not); hidden, h.lost:\n"
    "median error and share lost while hidden; 3 sigma: share of seen and inferred positions inside what the tracker "
    "claims. With --rig joints and depth are found with that rig and compared in its left camera's axes with the truth, which\n"
    "is in the true left camera's: what a wrong rig does to distances counts as error. Depth is judged as disparity of that "
    "rig.\n\n"
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
  TrackingOptions arm;
};

/// A click on each joint, moved by `jitter_px` in a direction of its own, the same in every run; the ends of limbs come first.
Selection clicks(const Skeleton& skeleton, const FrameTruth& truth, double jitter_px, std::mt19937& random) {
  Selection selection{&skeleton, {}};
  for (std::size_t j = skeleton.joints.size(); j-- > 0;) {
    const JointTruth& joint = *truth[static_cast<std::size_t>(skeleton.joints[j].id)];
    const double angle_rad = 2 * std::numbers::pi * static_cast<double>(random()) / 4294967296.0;
    selection.clicks.push_back(
        {skeleton.joints[j].id, joint.u_px + jitter_px * std::cos(angle_rad), joint.v_px + jitter_px * std::sin(angle_rad)});
  }
  return selection;
}

/// A joint that nobody has is lost.
JointSample sample(const JointTruth& truth, JointId id, std::span<const Person> people, const Mat3& rig_from_left) {
  for (const Person& person : people)
    if (const Joint* found = person.find(id)) {
      const Vec3 off_m = found->p_in_rig_m - rig_from_left * truth.p_in_left_m;
      return {truth.visible, found->state, 1000 * norm(off_m), 1000 * found->sigma_m()};
    }
  return {truth.visible, JointState::kLost, 0, 0};
}

/// What is scored, and whose joints have to be clicked for it.
struct Wanted {
  std::vector<JointId> joints, clicked;
  std::vector<const Skeleton*> skeletons;
};

Result<Wanted> wanted(const Tracker& tracker, const ClipTruth& truth, std::vector<JointId> joints) {
  const auto add = [](const Skeleton& skeleton, std::vector<JointId>& to) {
    for (std::size_t j = skeleton.joints.size(); j-- > 0;) to.push_back(skeleton.joints[j].id);
  };
  if (joints.empty())
    for (const Skeleton* skeleton : tracker.skeletons())
      if (tracker.starts_by_itself() || skeleton->joints[0].side == truth.arm) add(*skeleton, joints);
  Wanted out{std::move(joints), {}, {}};
  for (const JointId joint : out.joints) {
    DUO_TRY(truth.check(joint));
    const auto skeletons = tracker.skeletons();
    const auto with =
        std::find_if(skeletons.begin(), skeletons.end(), [&](const Skeleton* s) { return s->index_of(joint).has_value(); });
    if (with == skeletons.end())
      return Error{ErrorCode::kBadInput, fmt::format("cannot score {}: the tracker {} finds {}", name_of(joint), tracker.name(),
                                                     joint_names(skeletons))};
    if (tracker.starts_by_itself() || std::find(out.skeletons.begin(), out.skeletons.end(), *with) != out.skeletons.end())
      continue;
    out.skeletons.push_back(*with);
    add(**with, out.clicked);
  }
  for (const JointId joint : out.clicked) DUO_TRY(truth.check(joint));
  return out;
}

}  // namespace

Result<ClipScore> track_clip(const fs::path& folder, const ClipTruth& truth, const Rig& rig, const TrackingOptions& options,
                             const std::vector<JointId>& joints, double jitter_px, const std::string& video) {
  DUO_TRY_ASSIGN(const auto tracker, make_tracker(options.tracker));
  DUO_TRY_ASSIGN(const Wanted want, wanted(*tracker, truth, joints));
  ClipScore score{truth.name, options.tracker, 0, 0, 0, {}, {}, {}};
  DUO_TRY_ASSIGN(score.first, truth.first_visible(want.clicked));
  std::vector<Selection> selections;
  std::mt19937 random(1);
  for (const Skeleton* skeleton : want.skeletons)
    selections.push_back(clicks(*skeleton, truth.frames[static_cast<std::size_t>(score.first)], jitter_px, random));
  const std::string left = (folder / "left.avi").string(), right = (folder / "right.avi").string();
  DUO_TRY_ASSIGN(Input input, open_input(left, right, rig, truth.skew_ms));
  TrackingOptions tracking = options;
  tracking.all_maps = true;  // and not in bulk: other frames would be made while a frame is scored
  PipelineSetup setup = tracking.setup(input);
  setup.first = score.first;
  DUO_TRY_ASSIGN(Pipeline pipeline, Pipeline::open(std::move(input.pairs), std::move(setup)));
  const Rectified& rectified = pipeline.header().rectified;
  if (!video.empty()) {
    DUO_TRY_ASSIGN(auto sink, make_panel_video(video, pipeline.header(), score.note));
    DUO_TRY(pipeline.add_sink(video, std::move(sink)));
  }
  std::vector<std::vector<JointSample>> samples(want.joints.size());
  DepthTally depth;
  double busy_ms = 0;  // without scoring, during which nothing goes on in the background
  for (std::int64_t i = score.first; i < static_cast<std::int64_t>(truth.frames.size()); ++i) {
    const FrameTruth& frame = truth.frames[static_cast<std::size_t>(i)];
    Result<Next> next = Next::kEnd;
    Result<void> selected;
    busy_ms += timed([&] {
                 next = pipeline.next();
                 if (!next || *next != Next::kPicture) return;
                 if (i == score.first && !selections.empty()) selected = pipeline.select(selections);
                 pipeline.wait();
               }).wall_ms;
    if (!next) return next.error();
    if (!selected) return selected.error();
    if (*next != Next::kPicture)
      return Error{ErrorCode::kBadInput, fmt::format("cannot evaluate {}: its videos end before frame {} of {} in truth.json",
                                                     folder.string(), i, truth.frames.size())};
    for (std::size_t j = 0; j < want.joints.size(); ++j) {
      const JointId id = want.joints[j];
      samples[j].push_back(sample(*frame[static_cast<std::size_t>(id)], id, pipeline.people(), rectified.rig_from_left));
    }
    DUO_TRY_ASSIGN(const DepthTruth depth_truth, load_depth(folder, i));
    depth.add(*pipeline.frame(), rectified, truth.rig.left, depth_truth);
    DUO_TRY(pipeline.write());
    ++score.frames;
  }
  score.fps = 1000 * static_cast<double>(score.frames) / busy_ms;
  for (std::size_t j = 0; j < want.joints.size(); ++j) score.joints.emplace_back(want.joints[j], score_joint(samples[j]));
  score.depth = depth.score();
  DUO_TRY(pipeline.finish_sinks());
  return score;
}

namespace {

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
                                        {"inside_3_sigma_percent", or_null(s.inside_3_sigma_percent)}};
  nlohmann::json out = {{"clip", score.clip},     {"tracker", score.tracker}, {"first_frame", score.first},
                        {"frames", score.frames}, {"fps", score.fps},         {"joints", joints},
                        {"depth", nullptr}};
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

void print(const ClipScore& score) {
  for (const auto& [id, s] : score.joints) {
    const bool first = id == score.joints[0].first;
    const std::string recover =
        s.frames_to_recover ? fmt::format("{}{}", s.recovered ? "" : ">", *s.frames_to_recover) : std::string("-");
    fmt::print("{:<18} {:<8} {:<14} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n", first ? score.clip : "",
               first ? score.tracker : "", name_of(id), cell(s.median_mm, 1, ""), cell(s.p95_mm, 1, ""),
               cell(s.bad_percent, 1, "%"), recover, cell(s.hidden_median_mm, 1, ""), cell(s.hidden_lost_percent, 1, "%"),
               cell(s.inside_3_sigma_percent, 1, "%"));
  }
  fmt::print("{:<27} {} frames from {}, {:.1f} frames/s", "", score.frames, score.first, score.fps);
  if (score.depth)
    fmt::print(
        "; depth on the person: {:.1f} % covered, {:.1f} % off by more than 1 px, median {:.2f} px = {:.2f} %, "
        "bias {:+.3f} px, on the background {:+.3f} px",
        score.depth->coverage_percent, score.depth->bad_percent, score.depth->median_px, score.depth->median_depth_percent,
        score.depth->bias_px, score.depth->background_bias_px);
  fmt::print("\n");
}

}  // namespace

void print(const std::vector<ClipScore>& scores) {
  fmt::print("{:<18} {:<8} {:<14} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n", "clip", "tracker", "joint", "median", "p95",
             "bad", "recover", "hidden", "h.lost", "3 sigma");
  for (const ClipScore& score : scores) print(score);
}

namespace {

Result<Exit> run(const Options& options) {
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
    Options one = options;
    std::vector<std::string> trackers = {options.arm.tracker};
    if (options.compare) trackers = tracker_names();
    for (const std::string& tracker : trackers) {
      one.arm.tracker = tracker;
      DUO_TRY_ASSIGN(ClipScore score, track_clip(folder, truth, rig, one.arm, joints, options.jitter_px));
      scores.push_back(std::move(score));
    }
  }
  if (options.json) {
    nlohmann::json out = {
        {"bad_mm", kBad_mm}, {"jitter_px", options.jitter_px}, {"rig", options.rig}, {"clips", nlohmann::json::array()}};
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
  options->arm.add_to(*sub);
  sub->add_option("--joints", options->joints, "The joints to score, by name; without it those of the arm that moves")
      ->type_name("NAME,NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  sub->add_option("--jitter", options->jitter_px, "Moves each click by PX, as a hand would")
      ->type_name("PX")
      ->check(CLI::Range(0.0, 1000.0));
  sub->add_flag("--compare", options->compare, "Every tracker, one after the other");
  sub->add_flag("--json", options->json, "Print the scores as JSON");
  sub->footer(kFooter);
  return {sub, [options] { return run(*options); }};
}

}  // namespace duo::app::eval_clip
