#include "duoptic/rig_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "calib/judge_scene.h"
#include "calib/scene_pose.h"

namespace duo {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kLeastPan_rad = 0.6 / kDegrees;  // that is to be found

RigFit misfit(std::string what) { return {RigVerdict::kRecalibrate, std::move(what)}; }

/// How one camera may be held or set up that the other is not.
struct Posture {
  const char* what;
  Image<Rgb8> (*undone)(const Image<Rgb8>& picture);
};

template <class Place>
Image<Rgb8> moved_pixels(const Image<Rgb8>& picture, const Place& place) {
  const auto [w, h] = picture.size();
  Image<Rgb8> out(picture.size());
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const auto [from_x, from_y] = place(x, y);
      out.at(y, x) = from_x < 0 || from_y < 0 || from_x >= w || from_y >= h ? Rgb8{} : picture.at(from_y, from_x);
    }
  return out;
}

Image<Rgb8> half_turn(const Image<Rgb8>& picture) {
  const auto [w, h] = picture.size();
  return moved_pixels(picture, [w = w, h = h](int x, int y) { return std::pair(w - 1 - x, h - 1 - y); });
}
Image<Rgb8> mirror(const Image<Rgb8>& picture) {
  return moved_pixels(picture, [w = picture.width()](int x, int y) { return std::pair(w - 1 - x, y); });
}
/// Of the square in the middle; black beside it.
Image<Rgb8> quarter_turn(const Image<Rgb8>& picture) {
  const auto [w, h] = picture.size();
  const int side = std::min(w, h), x0 = (w - side) / 2, y0 = (h - side) / 2;
  return moved_pixels(picture, [=](int x, int y) {
    const int i = x - x0, j = y - y0;
    return i < 0 || j < 0 || i >= side || j >= side ? std::pair(-1, -1) : std::pair(x0 + j, y0 + side - 1 - i);
  });
}
Image<Rgb8> three_quarter_turn(const Image<Rgb8>& picture) { return half_turn(quarter_turn(picture)); }

constexpr char kOnSide[] = "one picture lies on its side: turn that camera by 90 degrees, or its picture";
constexpr Posture kPostures[] = {
    {"one picture stands on its head: turn that camera by 180 degrees, or its picture", half_turn},
    {"one picture is mirrored and the other is not: switch the mirroring of that camera off", mirror},
    {kOnSide, quarter_turn},
    {kOnSide, three_quarter_turn}};

std::size_t agreeing(const Rig& lenses, const SceneMatches& scene) {
  const auto matches = agreeing_matches(lenses, scene);
  return matches ? matches->size() : 0;
}

/// Why views with many points do not agree; empty: it is not known.
std::string why_apart(const Rig& lenses, const SceneMatches& scene, const Pair& pair, int threads) {
  constexpr int kManyPoints = 150;  // in either picture: a scene with texture, in light
  constexpr double kByChance =
      0.025;  // share of points that match in pictures of two places: up to 0.014; of one: from 0.05 on
  if (scene.fewest_points < kManyPoints) return {};
  Pair other{{pair.left.pixels.clone()}, {}};
  for (const Posture& posture : kPostures) {
    other.right.pixels = posture.undone(pair.right.pixels);
    if (agreeing(lenses, match_pair(other, threads)) > 0) return posture.what;
  }
  const double alike = static_cast<double>(scene.matches.size()) / scene.pairs;
  if (alike > kByChance * scene.fewest_points) return {};
  return fmt::format(
      "left and right have nothing in common: of {} points in a picture {:.0f} look alike; give pictures of one scene at one "
      "moment, of cameras that look the same way",
      scene.fewest_points, alike);
}

/// Of a pair that is taken as rectified: where its points would lie.
std::string why_not_rectified(const std::vector<SceneMatch>& matches) {
  std::vector<double> d_px;
  for (const SceneMatch& m : matches) d_px.push_back(m.left_px.x - m.right_px.x);
  std::sort(d_px.begin(), d_px.end());
  const auto at = [&](double share) { return d_px[static_cast<std::size_t>(share * static_cast<double>(d_px.size() - 1))]; };
  if (at(0.5) > -1) return {};
  if (at(0.9) > 1)
    return fmt::format(
        "most points lie up to {:.0f} px further right in the right picture than in the left one, as no rectified pair has "
        "them: "
        "give a rig, or move the pictures apart",
        -at(0.05));
  return fmt::format(
      "left and right are swapped, or both pictures are mirrored: points lie up to {:.0f} px further right in the right "
      "picture "
      "than in the left one; give them in the other order, or switch the mirroring of the cameras off",
      -at(0.05));
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

RigFit judged(const Rig& rig, const Evidence& evidence) {
  const auto health = judge_scene(rig, evidence);
  if (!health) return misfit(health.error().what);
  RigFit fit{health->verdict, {}, *health};
  // A few pairs are looked at in every run: what they may say by chance is not said. Where they could not tell the least pan
  // that is to be found, they must be sure of a larger one.
  constexpr double kToldPan_sigmas = 3;
  const bool could_tell = health->turned_sigma_rad.y <= kLeastPan_rad / kToldPan_sigmas;
  const bool pan_told = sure_of_pan(*health) || (could_tell && health->pan_px >= kToldPan_sigmas * health->pan_sigma_px);
  // Few points, on one side of the picture, have rows that are a little off by chance, too.
  constexpr double kEnoughCovered = 0.5;
  const bool rows_told = health->row_px >= kGoodRow_px && health->covered >= kEnoughCovered;
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

/// What points say; none: too few agree.
std::optional<RigFit> fit_by(const std::optional<Rig>& rig, const Rig& lenses, const SceneMatches& scene,
                             const RigFit& untold) {
  if (one_picture(scene.matches)) return misfit("left and right are the same picture; give one of each camera");
  const auto matches = agreeing_matches(lenses, scene);
  if (!matches) return {};
  if (!rig) {
    std::string why = why_not_rectified(*matches);
    return why.empty() ? untold : misfit(std::move(why));
  }
  const auto evidence = evidence_of(scene, *matches);
  return evidence ? judged(*rig, *evidence) : untold;
}

}  // namespace

RigFit rig_fit(const std::optional<Rig>& rig, std::span<const std::shared_ptr<const Pair>> pairs, int threads) {
  if (pairs.empty()) return {};
  if (rig)
    for (const RigDoubt& doubt : rig_doubts(*rig))
      if (doubt.verdict == RigVerdict::kRecalibrate) return misfit(fmt::format("the rig is of no use: {}", doubt.what));
  const RigFit untold = rig && !rig->metric ? not_metric({}) : RigFit();
  const Size size = pairs[0]->left.pixels.size();
  const Rig lenses = rig ? *rig : guessed_rig(size);
  if (!(lenses.left.size == size)) return untold;  // the engine refuses it
  const auto quick = fit_by(rig, lenses, match_pair(*pairs[0], threads, SceneSearch::kQuick), untold);
  if (quick && surely_good(rig, *quick)) return *quick;
  SceneMatcher matcher(size, threads);
  for (const auto& pair : pairs) matcher.add(*pair);
  if (auto fit = fit_by(rig, lenses, matcher.matches(), untold)) return *fit;
  std::string why = why_apart(lenses, matcher.matches(), *pairs.back(), threads);
  return why.empty() ? untold : misfit(std::move(why));
}

}  // namespace duo
