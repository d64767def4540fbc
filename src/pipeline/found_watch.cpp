#include "pipeline/found_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

#include "calib/judge_scene.h"
#include "duoptic/statistics.h"
#include "pipeline/flat_picture.h"

namespace duo {
namespace {

constexpr double kNothing = 0.02, kLittle = 0.1;  // share of pixels with a disparity; usual scenes have 0.6 and more
constexpr Size kSmallest = {64, 48};

double known_share(const Image<std::uint8_t>& origin) {
  std::int64_t known = 0;
  for (int y = 0; y < origin.height(); ++y)
    known +=
        origin.width() - std::count(origin.row(y), origin.row(y) + origin.width(), static_cast<std::uint8_t>(Origin::kNone));
  return static_cast<double>(known) / (static_cast<double>(origin.width()) * origin.height());
}

double mean_level(View<const Rgb8> picture) {
  constexpr int kStep = 4;
  std::int64_t sum = 0, count = 0;
  for (int y = 0; y < picture.height(); y += kStep)
    for (int x = 0; x < picture.width(); x += kStep, ++count)
      sum += picture.row(y)[x].r + 2 * picture.row(y)[x].g + picture.row(y)[x].b;
  return static_cast<double>(sum) / (4.0 * static_cast<double>(std::max<std::int64_t>(count, 1)));
}

}  // namespace

FoundWatch::FoundWatch(const Setup& frames, const Rectified& rectified, bool people)
    : on_(true), people_(people), rig_(frames.rig), max_disparity_(frames.max_disparity) {
  if (!rig_) return;
  px_of_lens_ = rectified.focal_px / rig_->left.fx_px;
  if (rig_->metric) disparity_by_depth_ = rectified.focal_px * rectified.baseline_m;
}

/// What can be seen in the pictures alone; empty: nothing.
std::string FoundWatch::cause_of(const Pair& pair) const {
  constexpr double kDark = 12;  // levels
  const Size size = pair.left.pixels.size();
  if (size.width < kSmallest.width || size.height < kSmallest.height)
    return fmt::format("pictures of {}x{} pixels are too small to be matched; give them as the cameras made them", size.width,
                       size.height);
  const View<const Rgb8> views[] = {pair.left.pixels.view(), pair.right.pixels.view()};
  const bool flat[] = {is_flat(views[0]), is_flat(views[1])};
  const auto which_of = [](bool left, bool right) {
    return left && right ? "both pictures" : left ? "the left picture" : "the right picture";
  };
  const double levels[] = {mean_level(views[0]), mean_level(views[1])};
  const bool dark[] = {levels[0] < kDark, levels[1] < kDark};
  if (dark[0] || dark[1])
    return fmt::format("{} {} dark, {:.0f} of 255 in the mean: light the scene, expose longer, or uncover the lens",
                       which_of(dark[0], dark[1]), dark[0] && dark[1] ? "are" : "is", std::min(levels[0], levels[1]));
  if (flat[0] || flat[1])
    return fmt::format("{} show{} no texture: a blank wall, a covered lens, or one that is out of focus",
                       which_of(flat[0], flat[1]), flat[0] && flat[1] ? "" : "s");
  return {};
}

/// None: too few points agree to tell.
std::optional<std::string> FoundWatch::too_near(const Pair& pair) const {
  constexpr double kMost = 0.25, kNearest = 0.98;  // of the points
  std::vector<double> d_px = seen_disparities_px(rig_, pair);
  if (d_px.empty()) return {};
  for (double& d : d_px) d *= px_of_lens_;
  const auto beyond = d_px.end() - std::lower_bound(d_px.begin(), d_px.end(), max_disparity_);
  const double share = static_cast<double>(beyond) / static_cast<double>(d_px.size());
  if (share < kMost) return "";
  constexpr int kStep_px = 16;
  const double nearest_px = quantile(std::move(d_px), kNearest);
  const int search_px =
      kStep_px * (static_cast<int>(std::min<double>(nearest_px, Engine::kMaxDisparity - kStep_px)) / kStep_px + 1);
  const bool metric = disparity_by_depth_ > 0;
  return fmt::format(
      "{:.0f} % of the points that both pictures show are nearer than what is searched, {} px of disparity{}, and depth is "
      "wrong there: give --max-disparity {}",
      100 * share, max_disparity_, metric ? fmt::format(" or {:.2f} m", disparity_by_depth_ / max_disparity_) : "", search_px);
}

void FoundWatch::see(const Frame& frame, const Pair& pair, std::size_t people) {
  constexpr std::int64_t kLooks = 64;
  // Frames 1, 2, 4, 8 and so on are looked into: a first picture may be black, and what follows is not.
  const auto is_looked_into = [](std::int64_t number) { return std::has_single_bit(static_cast<std::uint64_t>(number)); };
  if (!on_) return;
  ++counts_.frames;
  counts_.with_people += people > 0;
  if (!counts_.near && counts_.frames <= kLooks && is_looked_into(counts_.frames)) {
    counts_.near = too_near(pair);
    counts_.near_frame = pair.sequence;
  }
  if (!frame.matched.empty() || frame.disparity.origin.empty()) return;
  ++counts_.whole;
  const double known = known_share(frame.disparity.origin);
  counts_.known += known;
  if (known < kLittle && is_looked_into(++counts_.little)) counts_.cause = cause_of(pair);
}

std::string FoundWatch::warning(bool cause_told) const {
  const Counts& c = counts_;
  const double known = c.whole > 0 ? c.known / static_cast<double>(c.whole) : 1;
  const bool nothing = known < kNothing;
  const auto too_near = [&] { return (c.frames > 1 ? fmt::format("in frame {} ", c.near_frame) : "") + *c.near; };
  const std::string why = cause_told ? "" : c.near && !c.near->empty() ? too_near() : nothing ? c.cause : "";
  if (people_ && c.with_people == 0 && c.ended)
    return fmt::format("nobody was found in {} frame{}{}{}", c.frames, c.frames == 1 ? "" : "s", cause_told ? "" : ": ",
                       cause_told     ? ""
                       : !why.empty() ? why
                                      : "the networks know no person in the left pictures, or nothing stands out there by its "
                                        "depth; people have to be in light, upright, and in the picture from head to hips");
  if (!nothing || cause_told) return why;
  return fmt::format("almost nothing was found, {:.1f} % of the pixels have a disparity{}{}", 100 * known,
                     why.empty() ? "" : ": ", why);
}

}  // namespace duo
