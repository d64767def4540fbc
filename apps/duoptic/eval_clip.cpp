// duoptic eval clip: the tracker against clips with exact joints and depth.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "eval_clip.h"
#include "timing.h"

namespace duo::app::eval_clip {
namespace {

namespace fs = std::filesystem;

constexpr char kFooter[] =
    "A clip is a folder with left.avi, right.avi, calibration_truth.yml and truth.json, perhaps depth/. The clicks are the "
    "truth\n"
    "at the first frame that shows the whole arm to both cameras; scores are of the frames from there on.\n"
    "median, p95: error in mm where the joint is visible; bad: of these frames, lost or off by more than 100 mm; recover: the\n"
    "most frames from coming out after 5 or more hidden ones to being tracked again (> at the end still not); hidden, h.lost:\n"
    "median error and share lost while hidden; 3 sigma: share of seen and inferred positions inside what the tracker "
    "claims. With --rig joints and depth are found with that rig and compared in its left camera's axes with the truth, which\n"
    "is in the true left camera's: what a wrong rig does to distances counts as error. Depth is judged as disparity of that "
    "rig.\n\n"
    "Examples:\n"
    "  duoptic eval clip data/sequences/dev_easy_wave\n"
    "  duoptic eval clip clips/* --compare --json\n"
    "  duoptic eval clip data/sequences/dev_easy_wave --rig rig.json";

struct Options {
  std::vector<std::string> folders;
  std::string rig;  // empty: each clip's true one
  double jitter_px = 0;
  bool compare = false, json = false;
  ArmOptions arm;
};

/// The truth, each click moved by `jitter_px` in a direction of its own, the same in every run.
ArmSelection clicks(const ArmTruth& truth, double jitter_px) {
  ArmSelection selection;
  std::mt19937 random(1);
  for (std::size_t j = 0; j < kArmJoints; ++j) {
    const double angle_rad = 2 * std::numbers::pi * static_cast<double>(random()) / 4294967296.0;
    selection.clicks[j] = {truth[j].u_px + jitter_px * std::cos(angle_rad), truth[j].v_px + jitter_px * std::sin(angle_rad)};
  }
  return selection;
}

JointSample sample(const JointTruth& truth, const Keypoint& found, const Mat3& rig_from_left) {
  const Vec3 off_m = found.p_in_rig_m - rig_from_left * truth.p_in_left_m;
  return {truth.visible, found.state, 1000 * norm(off_m), 1000 * found.sigma_m};
}

}  // namespace

Result<ClipScore> track_clip(const fs::path& folder, const ClipTruth& truth, const Rig& rig, const ArmOptions& options,
                             double jitter_px, const std::string& video) {
  ClipScore score{truth.name, options.tracker_preset, truth.first_visible(), 0, 0, {}, {}, {}};
  const std::string left = (folder / "left.avi").string(), right = (folder / "right.avi").string();
  DUO_TRY_ASSIGN(Input input, open_input(left, right, rig, truth.skew_ms));
  ArmOptions arm = options;
  arm.all_maps = true;  // and not in bulk: other frames would be made while a frame is scored
  DUO_TRY_ASSIGN(ArmRun run, ArmRun::open(std::move(input), arm, score.first));
  const Rectified& rectified = run.header().rectified;
  std::unique_ptr<Sink> sink;
  if (!video.empty()) {
    DUO_TRY_ASSIGN(sink, make_panel_video(video, run.header(), score.note));
  }
  std::array<std::vector<JointSample>, kArmJoints> samples;
  DepthTally depth;
  double busy_ms = 0;  // without scoring, during which nothing goes on in the background
  for (std::int64_t i = score.first; i < static_cast<std::int64_t>(truth.frames.size()); ++i) {
    const ArmTruth& joints = truth.frames[static_cast<std::size_t>(i)];
    Result<Next> next = Next::kEnd;
    const std::vector<ArmPose>* arms = nullptr;
    Result<void> selected;
    busy_ms += timed([&] {
                 next = run.next();
                 if (!next || *next != Next::kPicture) return;
                 if (i == score.first) selected = run.select({clicks(joints, jitter_px)});
                 if (selected) arms = &run.track();
                 run.frames().wait();
               }).wall_ms;
    if (!next) return next.error();
    if (!selected) return selected.error();
    if (*next != Next::kPicture)
      return Error{ErrorCode::kBadInput, fmt::format("cannot evaluate {}: its videos end before frame {} of {} in truth.json",
                                                     folder.string(), i, truth.frames.size())};
    for (std::size_t j = 0; j < kArmJoints; ++j)
      samples[j].push_back(sample(joints[j], arms->front().joints[j], rectified.rig_from_left));
    DUO_TRY_ASSIGN(const DepthTruth depth_truth, load_depth(folder, i));
    depth.add(run.frame(), rectified, truth.rig.left, depth_truth);
    if (sink) DUO_TRY(sink->write(run.tracked(*arms)));
    ++score.frames;
  }
  score.fps = 1000 * static_cast<double>(score.frames) / busy_ms;
  for (std::size_t j = 0; j < kArmJoints; ++j) score.joints[j] = score_joint(samples[j]);
  score.depth = depth.score();
  if (sink) DUO_TRY(sink->finish());
  return score;
}

namespace {

template <class T>
nlohmann::json or_null(const std::optional<T>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

nlohmann::json to_json(const ClipScore& score) {
  nlohmann::json joints = nlohmann::json::object();
  for (std::size_t j = 0; j < kArmJoints; ++j) {
    const JointScore& s = score.joints[j];
    joints[std::string(kJointNames[j])] = {{"median_mm", or_null(s.median_mm)},
                                           {"p95_mm", or_null(s.p95_mm)},
                                           {"lost_or_off_percent", or_null(s.bad_percent)},
                                           {"frames_to_recover", or_null(s.frames_to_recover)},
                                           {"recovered", s.recovered},
                                           {"hidden_median_mm", or_null(s.hidden_median_mm)},
                                           {"hidden_lost_percent", or_null(s.hidden_lost_percent)},
                                           {"inside_3_sigma_percent", or_null(s.inside_3_sigma_percent)}};
  }
  nlohmann::json out = {{"clip", score.clip},
                        {"tracker_preset", score.tracker_preset},
                        {"first_frame", score.first},
                        {"frames", score.frames},
                        {"fps", score.fps},
                        {"joints", joints},
                        {"depth", nullptr}};
  if (const auto& d = score.depth)
    out["depth"] = {{"coverage_percent", d->coverage_percent},
                    {"bad_percent", d->bad_percent},
                    {"median_px", d->median_px},
                    {"median_depth_percent", d->median_depth_percent}};
  return out;
}

std::string cell(const std::optional<double>& value, int digits, const char* unit) {
  return value ? fmt::format("{:.{}f}{}", *value, digits, unit) : "-";
}

void print(const ClipScore& score) {
  for (std::size_t j = 0; j < kArmJoints; ++j) {
    const JointScore& s = score.joints[j];
    const std::string recover =
        s.frames_to_recover ? fmt::format("{}{}", s.recovered ? "" : ">", *s.frames_to_recover) : std::string("-");
    fmt::print("{:<18} {:<8} {:<9} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n", j == 0 ? score.clip : "",
               j == 0 ? score.tracker_preset : "", kJointNames[j], cell(s.median_mm, 1, ""), cell(s.p95_mm, 1, ""),
               cell(s.bad_percent, 1, "%"), recover, cell(s.hidden_median_mm, 1, ""), cell(s.hidden_lost_percent, 1, "%"),
               cell(s.inside_3_sigma_percent, 1, "%"));
  }
  fmt::print("{:<27} {} frames from {}, {:.1f} frames/s", "", score.frames, score.first, score.fps);
  if (score.depth)
    fmt::print("; depth on the person: {:.1f} % covered, {:.1f} % off by more than 1 px, median {:.2f} px = {:.2f} %",
               score.depth->coverage_percent, score.depth->bad_percent, score.depth->median_px,
               score.depth->median_depth_percent);
  fmt::print("\n");
}

}  // namespace

void print(const std::vector<ClipScore>& scores) {
  fmt::print("{:<18} {:<8} {:<9} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n", "clip", "tracker", "joint", "median", "p95",
             "bad", "recover", "hidden", "h.lost", "3 sigma");
  for (const ClipScore& score : scores) print(score);
}

namespace {

Result<Exit> run(const Options& options) {
  std::vector<ClipScore> scores;
  for (const std::string& folder : options.folders) {
    DUO_TRY_ASSIGN(const ClipTruth truth, load_clip(folder));
    Rig rig = truth.rig;
    if (!options.rig.empty()) {
      DUO_TRY_ASSIGN(rig, load_rig(options.rig));
    }
    Options one = options;
    std::vector<std::string> presets = {options.arm.tracker_preset};
    if (options.compare) presets = {"default", "thesis"};
    for (const std::string& preset : presets) {
      one.arm.tracker_preset = preset;
      DUO_TRY_ASSIGN(ClipScore score, track_clip(folder, truth, rig, one.arm, options.jitter_px));
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
  sub->add_option("--jitter", options->jitter_px, "Moves each click by PX, as a hand would")
      ->type_name("PX")
      ->check(CLI::Range(0.0, 1000.0));
  sub->add_flag("--compare", options->compare, "Both presets of the tracker, one after the other");
  sub->add_flag("--json", options->json, "Print the scores as JSON");
  sub->footer(kFooter);
  return {sub, [options] { return run(*options); }};
}

}  // namespace duo::app::eval_clip
