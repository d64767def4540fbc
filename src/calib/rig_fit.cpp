#include "duoptic/rig_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "calib/judge_scene.h"
#include "calib/moved_points.h"
#include "calib/postures.h"
#include "calib/rig_fitting.h"
#include "calib/row_offsets.h"
#include "calib/scene_pose.h"
#include "duoptic/statistics.h"

namespace duo {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kLeastPan_rad = 0.6 / kDegrees;  // that is to be found

RigFit misfit(std::string what) { return {RigVerdict::kRecalibrate, std::move(what)}; }

/// Of a pair that is taken as rectified: how its rows differ, where most points lie further apart than what is put right.
std::string why_rows_differ(const std::vector<SceneMatch>& matches, int height) {
  constexpr double kMost = 0.4;  // of the points, in one band
  std::vector<double> rows_px;
  for (const SceneMatch& m : matches) rows_px.push_back(m.right_px.y - m.left_px.y);
  std::sort(rows_px.begin(), rows_px.end());
  std::size_t most = 0;
  for (auto from = rows_px.begin(); from != rows_px.end(); ++from) {
    const auto to = std::upper_bound(from, rows_px.end(), *from + 2 * row_reach_px(height));
    most = std::max(most, static_cast<std::size_t>(to - from));
  }
  if (static_cast<double>(most) > kMost * static_cast<double>(rows_px.size())) return {};
  return fmt::format(
      "the rows of both pictures do not fit: in the right one the same points lie {:+.0f} to {:+.0f} px away (+: lower), as in "
      "no rectified pair: give a rig; or one picture was zoomed, cropped or scaled, or a camera is turned",
      rows_px[rows_px.size() / 20], rows_px[rows_px.size() - 1 - rows_px.size() / 20]);
}

/// Median of what they keep when that plane is taken off them.
double off_plane_px(const std::vector<SceneMatch>& matches, double (*value)(const SceneMatch&)) {
  const MatchPlane plane = plane_of(matches, value);
  std::vector<double> off;
  for (const SceneMatch& m : matches) off.push_back(std::abs(value(m) - plane.at(m.left_px)));
  return median(off);
}

double disparity_px(const SceneMatch& m) { return m.left_px.x - m.right_px.x; }

/// Depth moves points along rows where the cameras stand side by side, and along columns where both pictures lie on their side.
std::string why_along_columns(const std::vector<SceneMatch>& matches) {
  constexpr double kTimes = 3, kLeast_px = 1.5;
  const double across_px = off_plane_px(matches, disparity_px),
               down_px = off_plane_px(matches, [](const SceneMatch&m) { return m.left_px.y - m.right_px.y; });
  if (down_px < kLeast_px || down_px < kTimes * across_px) return {};
  return "both pictures lie on their side, or one camera stands above the other: things at other distances lie in other rows, "
         "not in other columns; turn both pictures by 90 degrees, or both cameras";
}

std::vector<double> disparities_px(const std::vector<SceneMatch>& matches, double per_column = 0) {
  std::vector<double> out;
  for (const SceneMatch& m : matches) out.push_back(disparity_px(m) - per_column * m.left_px.x);
  return out;
}
double share_of(const std::vector<double>& values, double share) { return quantile(std::vector(values), share); }
double spread(const std::vector<double>& values) { return share_of(values, 0.95) - share_of(values, 0.05); }

/// Of a pair that is taken as rectified: whether most points lie beyond infinity, and none before it.
std::string why_swapped(const std::vector<SceneMatch>& matches) {
  const std::vector<double> d_px = disparities_px(matches);
  if (share_of(d_px, 0.5) > -1 || share_of(d_px, 0.9) > 1) return {};
  return fmt::format(
      "left and right are swapped, or both pictures are mirrored: points lie up to {:.0f} px further right in the right "
      "picture than in the left one; give them in the other order, or switch the mirroring of the cameras off",
      -share_of(d_px, 0.05));
}

/// The same where some of them do.
std::string why_columns_differ(const std::vector<SceneMatch>& matches) {
  constexpr double kSome = 0.1, kBehind_px = -2;
  constexpr double kLevelled = 0.5,  // of the spread of disparities, where one per column is taken off them
      kLeast = 0.1;                  // a wall at an angle has less from side to side
  const std::vector<double> d_px = disparities_px(matches);
  if (share_of(d_px, 0.5) > -1 && share_of(d_px, kSome) > kBehind_px) return {};
  const double stretch = plane_of(matches, disparity_px).per_column;
  if (std::abs(stretch) >= kLeast && spread(disparities_px(matches, stretch)) < kLevelled * spread(d_px))
    return fmt::format(
        "the right picture is {:.0f} % {} than the left one: points lie {:.0f} px further right in it to {:.0f} px further "
        "left, as if one was stretched; give both as their cameras made them",
        100 * std::abs(stretch), stretch > 0 ? "narrower" : "wider", -share_of(d_px, 0.05), share_of(d_px, 0.95));
  return fmt::format(
      "many points lie up to {:.0f} px further right in the right picture than in the left one, as no rectified pair has them: "
      "give a rig, or move the pictures apart",
      -share_of(d_px, 0.05));
}

std::string misfit_text(const SceneHealth& h) {
  const Vec3 turned = kDegrees * h.turned_rad;
  std::string text =
      fmt::format("the rig does not fit these pictures ({}): rows are {:.1f} px off", name_of(h.verdict), h.row_px);
  if (h.pan_px > 2 * h.pan_sigma_px) text += fmt::format(" and disparities by {:.1f} +- {:.1f} px", h.pan_px, h.pan_sigma_px);
  if (h.lens_row_px >= kUselessRow_px)
    return text +
           fmt::format("; {:.1f} px remain however the cameras are turned: is it another rig's file, or was a lens zoomed?",
                       h.lens_row_px);
  return text + fmt::format(
                    "; a camera was turned by tilt {:.2f}, pan {:.2f}, roll {:.2f} degrees since it was calibrated, or it is "
                    "another rig's file: put it right with duoptic rig refine, or calibrate",
                    turned.x, turned.y, turned.z);
}

RigFit not_metric(RigFit fit) {
  fit.verdict = RigVerdict::kCanBeImproved;
  fit.what =
      "the rig is not metric: its baseline is a guess, and all distances are in units of that guess, not in metres; calibrate "
      "with a board, or make it with the lenses' calibration and --baseline-m";
  return fit;
}

/// The pan of one camera, if nothing else was moved: of both that could have been turned the one that fits better, where the
/// points are sure of either, and the free pose does not turn the other way.
std::optional<ScenePose> one_camera_pan(const Rig& rig, const Evidence& evidence, const SceneHealth& health) {
  constexpr double kSure_sigmas = 3, kLeast_rad = kLeastPan_rad / 2;
  std::optional<ScenePose> best;
  if (std::abs(health.turned_rad.y) < kLeast_rad) return best;
  for (const SceneFreedom& freedom : {kLeftTurned, kRightTurned}) {
    const auto pose = fit_scene_pose(rig, freedom, evidence.matches, evidence.as_one, evidence.of_patches);
    if (!pose) return {};
    const double pan_rad = std::copysign(1, health.turned_rad.y) * pose->turned_rad.y;
    if (pan_rad < std::max(kLeast_rad, kSure_sigmas * pose->turn_sigma_rad.y)) return {};
    if (!best || pose->row_rms_px < best->row_rms_px) best = *pose;
  }
  return best;
}

/// `least_row_px`: less is not told.
RigFit judged(const Rig& rig, const Evidence& evidence, double least_row_px = kGoodRow_px) {
  auto health = judge_scene(rig, evidence);
  if (!health) return misfit(health.error().what);
  std::optional<ScenePose> turned;
  if (health->verdict != RigVerdict::kRecalibrate && rig.metric) turned = one_camera_pan(rig, evidence, *health);
  if (turned) {
    take_pose(rig, *turned, evidence, *health);
    health->verdict = RigVerdict::kCanBeImproved;
  }
  RigFit fit{health->verdict, {}, *health};
  // A few pairs are looked at in every run: what they may say by chance is not said. Where they could not tell the least pan
  // that is to be found, they must be sure of a larger one.
  constexpr double kToldPan_sigmas = 3;
  const bool could_tell = health->turned_sigma_rad.y <= kLeastPan_rad / kToldPan_sigmas;
  const bool pan_told =
      turned || sure_of_pan(*health) || (could_tell && health->pan_px >= kToldPan_sigmas * health->pan_sigma_px);
  // Few points, on one side of the picture, have rows that are a little off by chance, too.
  constexpr double kEnoughCovered = 0.5;
  const bool rows_told = health->row_px >= least_row_px && health->covered >= kEnoughCovered;
  if (fit.verdict == RigVerdict::kCanBeImproved && !rows_told && !pan_told) fit.verdict = RigVerdict::kGood;
  if (fit.verdict == RigVerdict::kGood) return rig.metric ? fit : not_metric(std::move(fit));
  fit.what = misfit_text(*health);
  fit.disparity_sigma_px = std::hypot(health->row_px, health->pan_px > 2 * health->pan_sigma_px ? health->pan_px : 0);
  return fit;
}

/// Whether what was seen says that all is right, so that no more need be looked at.
bool surely_good(const std::optional<Rig>& rig, const RigFit& fit) {
  constexpr double kSurelyRight_px = 0.15, kSurely_sigmas = 3;
  if (!rig) return fit.what.empty();
  if (fit.verdict != RigVerdict::kGood || !fit.scene) return false;
  const double most_rad = std::abs(fit.scene->turned_rad.y) + kSurely_sigmas * fit.scene->turned_sigma_rad.y;
  return fit.scene->row_px < kSurelyRight_px && most_rad < kLeastPan_rad;
}

/// Whether what was seen says that something is wrong, by so much that no more need be looked at.
bool surely_wrong(const RigFit& fit) {
  constexpr double kSurelyCovered = 0.25, kSurelyPan_sigmas = 5;
  if (fit.what.empty() || fit.verdict != RigVerdict::kRecalibrate) return false;
  if (!fit.scene) return true;  // swapped, mirrored, one picture twice
  const bool rows = fit.scene->row_px >= 2 * kUselessRow_px && fit.scene->covered >= kSurelyCovered;
  return rows || fit.scene->pan_px >= kSurelyPan_sigmas * fit.scene->pan_sigma_px;
}

/// What is said where the pairs tell nothing.
RigFit untold(const std::optional<Rig>& rig) { return rig && !rig->metric ? not_metric({}) : RigFit(); }

/// What needs no picture: numbers that are of no use. Pictures of another size are the engine's to refuse.
std::optional<RigFit> fit_by_numbers(const std::optional<Rig>& rig, Size size) {
  if (!rig) return {};
  for (const RigDoubt& doubt : rig_doubts(*rig))
    if (doubt.verdict == RigVerdict::kRecalibrate) return misfit(fmt::format("the rig is of no use: {}", doubt.what));
  return rig->left.size == size ? std::nullopt : std::optional(untold(rig));
}

}  // namespace

RigFitting::RigFitting(std::optional<Rig> rig, Size size, int threads, SceneSearch most, bool still)
    : rig_(std::move(rig)),
      lenses_(rig_ ? *rig_ : guessed_rig(size)),
      size_(size),
      threads_(threads),
      most_(most),
      still_(still) {}

void RigFitting::add(const std::shared_ptr<const Pair>& pair) {
  if (!matcher_) matcher_.emplace(size_, threads_, most_);
  matcher_->add(*pair);
  last_ = pair;
}

/// None: too few points agree.
std::optional<RigFit> RigFitting::by_matches(const SceneMatches& scene, const Pair& last) const {
  if (one_picture(scene.matches)) return misfit("left and right are the same picture; give one of each camera");
  const auto matches = agreeing_matches(lenses_, scene);
  if (!matches) return {};
  RigFit fit = by_agreeing(scene, *matches);
  if (!still_ || !fit.what.empty() || (rig_ && !fit.scene)) return fit;  // of a rig that was not judged the rows tell nothing
  fit.what = why_moved(rig_, scene, *matches, last);
  if (!fit.what.empty()) fit.verdict = RigVerdict::kCanBeImproved;
  return fit;
}

RigFit RigFitting::by_agreeing(const SceneMatches& scene, const std::vector<SceneMatch>& matches) const {
  if (!rig_) {
    std::string why = why_along_columns(matches);
    if (why.empty()) why = why_swapped(matches);
    if (why.empty()) why = why_rows_differ(matches, size_.height);
    if (why.empty()) why = why_columns_differ(matches);
    return why.empty() ? RigFit() : misfit(std::move(why));
  }
  const auto evidence = evidence_of(scene, matches);
  return evidence ? judged(*rig_, *evidence) : untold(rig_);
}

std::optional<RigFit> RigFitting::by_first(const std::shared_ptr<const Pair>& pair) {
  if (auto known = fit_by_numbers(rig_, size_)) return known;
  const auto sure = [&](const std::optional<RigFit>& fit, SceneSearch search) {
    if (!fit || !(surely_good(rig_, *fit) || surely_wrong(*fit))) return false;
    // What is said without a judged scene needs more points than a quick search finds.
    return search == SceneSearch::kThorough || fit->scene || fit->what.empty();
  };
  if (most_ != SceneSearch::kQuick)
    if (auto fit = by_matches(match_pair(*pair, threads_, SceneSearch::kQuick), *pair); sure(fit, SceneSearch::kQuick))
      return fit;
  add(pair);
  first_ = by_matches(matcher_->matches(), *pair);
  return sure(first_, most_) ? first_ : std::nullopt;
}

bool RigFitting::looks_at_sum() const { return rig_ && rig_->metric && most_ != SceneSearch::kQuick; }

/// None: it knows no better than three pairs do, or leaves a doubt.
std::optional<RigFit> RigFitting::by_sum(const PairSum& sum) const {
  constexpr int kFewestPairs = 4;
  if (!looks_at_sum() || sum.pairs() < kFewestPairs) return {};
  const SceneMatches scene = match_patches(*rig_, sum);
  const auto matches = agreeing_matches(lenses_, scene);
  if (!matches) return {};
  const auto evidence = evidence_of(scene, *matches);
  if (!evidence) return {};
  // Medians of a dozen places that are known to tenths are off by a quarter of a pixel by chance.
  RigFit fit = judged(*rig_, *evidence, kUselessRow_px);
  constexpr double kSure_rad = kLeastPan_rad / 3.5;  // noisier patches know less than their own errors say
  const bool told =
      !fit.what.empty() && fit.scene && (fit.scene->turned_sigma_rad.y <= kSure_rad || fit.scene->row_px >= kUselessRow_px);
  return told ? std::optional(std::move(fit)) : std::nullopt;
}

RigFit RigFitting::by_all(std::span<const std::shared_ptr<const Pair>> others, const PairSum* sum) {
  // A quick search that found enough in the first finds the same in the others.
  const bool same = most_ == SceneSearch::kQuick && first_ && first_->scene;
  for (const auto& pair : others)
    if (same)
      matcher_->add_same(*pair);
    else
      add(pair);
  if (!matcher_ || !last_) return untold(rig_);
  const SceneMatches scene = matcher_->matches();
  const auto fit = others.empty() ? first_ : by_matches(scene, *last_);
  // What looks alike by chance agrees, too, where it stands in pair after pair.
  const bool by_chance = fit && !first_ && scene.fewest_points >= kManyPoints && !are_of_one_scene(scene);
  if (std::string why = by_chance ? why_held_otherwise(scene, *last_, threads_) : ""; !why.empty()) return misfit(std::move(why));
  if (fit && (!fit->what.empty() || surely_good(rig_, *fit))) return *fit;
  if (auto more = sum != nullptr ? by_sum(*sum) : std::nullopt) return *more;
  if (fit) return *fit;
  // Why they do not agree is told by more points than a quick search finds, whose many tell that they are of one scene.
  constexpr std::size_t kMany = 6;
  if (most_ == SceneSearch::kQuick && alike_in(scene) >= kMany && are_of_one_scene(scene)) return untold(rig_);
  std::string why = why_apart(most_ == SceneSearch::kQuick ? match_pair(*last_, threads_) : scene, *last_, threads_);
  return why.empty() ? untold(rig_) : misfit(std::move(why));
}

RigFit rig_fit(const std::optional<Rig>& rig, std::span<const std::shared_ptr<const Pair>> pairs, int threads) {
  if (pairs.empty()) return {};
  RigFitting fitting(rig, pairs[0]->left.pixels.size(), threads);
  if (const auto fit = fitting.by_first(pairs[0])) return *fit;
  std::optional<PairSum> sum;
  if (fitting.looks_at_sum()) {
    sum.emplace(pairs[0]->left.pixels.size());
    for (const auto& pair : pairs) sum->add(*pair);
  }
  return fitting.by_all(pairs.subspan(1), sum ? &*sum : nullptr);
}

}  // namespace duo
