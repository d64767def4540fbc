#include "trackers/body/newcomers.h"

#include <algorithm>

#include "trackers/body/seen_trunk.h"

namespace duo::body {
namespace {

constexpr double kSame_m = 0.4;
constexpr std::int64_t kPatience = 6;  // calls until it is asked about again

double across_floor(Vec3 a, Vec3 b) { return std::sqrt(square(a.x - b.x) + square(a.z - b.z)); }

/// Whether a trunk is where that of somebody would be who is as high as something upright.
bool fits(const FrameView& frame, const TrunkCorners& corners, const Upright& upright) {
  constexpr double kReach_m = 0.35, kShortest_m = 0.32, kShoulders_m = 0.25, kShouldersOff_m = 0.25, kCutOff_m = 0.45;
  const Window& box = upright.box_px;
  const double px_per_m = frame.depth.px_per_m(upright.z_m);
  const Vec2 up = mean(corners[0], corners[1]), down = mean(corners[2], corners[3]), middle_px = centre_of(corners);
  const double below_top_m = (up.y - box.y) / px_per_m;
  const double off_m = std::abs(below_top_m - (upright.cut_above ? 0 : kShoulders_m));
  return trunk_depth(frame.depth, corners, {upright.z_m - kReach_m, upright.z_m + kReach_m}) > 0 && middle_px.x > box.x &&
         middle_px.x < box.x_end() && (down.y - up.y) / px_per_m > kShortest_m &&
         off_m < (upright.cut_above ? kCutOff_m : kShouldersOff_m);
}

/// Comes to rest on somebody whose trunk is where something upright is.
std::optional<TurnedSquare> settle(Detector& detector, const FrameView& frame, const Upright& upright, double above_m) {
  constexpr int kLooks = 3;
  constexpr std::uint16_t kPerhaps = 9830, kSure = 21299;  // 0.3 and 0.65
  TurnedSquare region = region_of(frame.depth, upright, above_m);
  SeenBody seen;
  for (int i = 0; i < kLooks; ++i) {
    const Look look = {frame.picture, region};
    detector.bodies({&look, 1}, {&seen, 1});
    if (seen.score_q15 < (i + 1 < kLooks ? kPerhaps : kSure)) return std::nullopt;
    region = seen.next;
  }
  if (!fits(frame, corners_of(seen), upright)) return std::nullopt;
  return region;
}

}  // namespace

void Newcomers::Places::add(Vec3 at, std::int64_t until) {
  all[next] = {at, until};
  next = (next + 1) % all.size();
}

bool Newcomers::was_refused(Vec3 at) const {
  const auto is_there = [&](const Place& each) { return each.until > call_ && across_floor(each.at, at) < kSame_m / 2; };
  return std::ranges::any_of(things_.all, is_there) || std::ranges::any_of(mistakes_.all, is_there);
}

bool Newcomers::was_mistaken(Vec3 trunk) const {
  return std::ranges::any_of(mistakes_.all,
                             [&](const Place& each) { return each.until > call_ && norm(each.at - trunk) < kSame_m / 2; });
}

void Newcomers::add_mistake(Vec3 trunk) { mistakes_.add(trunk, call_ + kPatience); }

std::optional<TurnedSquare> Newcomers::look(Detector& detector, const FrameView& frame, std::span<const Vec3> tracked) {
  ++call_;
  for (const Upright& upright : uprights_.find(frame.depth)) {
    const Window& box = upright.box_px;
    const Vec3 at = frame.depth.geometry->unproject({box.x + box.width / 2.0, box.y + box.height / 2.0}, upright.z_m);
    const auto is_near = [&](Vec3 other) { return across_floor(at, other) < kSame_m; };
    if (std::ranges::any_of(tracked, is_near) || was_refused(at)) continue;
    // Of whom the upper border cuts nobody knows how much is out: the head, the hair, or the shoulders as well.
    constexpr std::array kAbove_m = {0.32, 0.1, 0.5};
    std::optional<TurnedSquare> found;
    for (std::size_t i = 0; i < (upright.cut_above ? kAbove_m.size() : 1) && !found; ++i)
      found = settle(detector, frame, upright, upright.cut_above ? kAbove_m[i] : 0);
    if (!found) things_.add(at, call_ + kPatience);
    return found;
  }
  return std::nullopt;
}

}  // namespace duo::body
