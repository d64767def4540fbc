#include "pipeline/focus_line.h"

#include <algorithm>
#include <cmath>

namespace duo {
namespace {

constexpr double kAround_m = 0.25;
constexpr double kNearest_m = 0.3;     // nobody is tracked nearer
constexpr double kRowsPerMetre = 250;  // enough of a person: what 640x480 have of who stands 2.2 m away

bool is_missed(const Person& person) {
  const std::span joints(person.joints.data(), person.count());
  return std::ranges::none_of(joints, [](const Joint& joint) { return joint.state == JointState::kSeen; });
}

}  // namespace

Focus around(std::span<const Person> people, const Rectified& rectified, double ahead_s) {
  double farthest_m = 0;
  double left = rectified.size.width, top = rectified.size.height, right = 0, bottom = 0;
  for (const Person& person : people)
    for (std::size_t i = 0; i < person.count(); ++i) {
      const Joint& joint = person.joints[i];
      if (joint.state == JointState::kLost) continue;
      for (const double s : {0.0, ahead_s}) {
        const Vec3 p_m = joint.p_in_rig_m + s * joint.v_in_rig_m_s;
        const double z_m = std::max(p_m.z, kNearest_m);
        farthest_m = std::max(farthest_m, z_m);
        const Vec2 at = rectified.project({p_m.x, p_m.y, z_m});
        const double reach = rectified.focal_px * kAround_m / std::max(z_m - kAround_m, kNearest_m);
        left = std::min(left, at.x - reach), right = std::max(right, at.x + reach);
        top = std::min(top, at.y - reach), bottom = std::max(bottom, at.y + reach);
      }
    }
  const auto whole = [](double px, int most) { return static_cast<int>(std::clamp(px, 0.0, static_cast<double>(most))); };
  Focus out;
  out.disparity_end = Engine::kMaxDisparity;
  out.window.x = whole(left, rectified.size.width), out.window.y = whole(top, rectified.size.height);
  out.window.width = whole(right + 1, rectified.size.width) - out.window.x;
  out.window.height = whole(bottom + 1, rectified.size.height) - out.window.y;
  out.row_step = rectified.focal_px >= 2 * kRowsPerMetre * farthest_m ? 2 : 1;
  return out.window.empty() ? Focus() : out;
}

void FocusLine::tell(std::span<const Person> people, TimeNs t_ns) {
  constexpr double kIntervals = 2, kMost_s = 1;  // one until the pair is taken, one until the next comes
  const double interval_s = static_cast<double>(t_ns - last_ns_.value_or(t_ns)) * 1e-9;
  last_ns_ = t_ns;
  const Told told = {around(people, rectified_, std::max(ahead_s_, std::min(kIntervals * interval_s, kMost_s))),
                     std::ranges::any_of(people, is_missed)};
  {
    const std::lock_guard lock(mutex_);
    ring_[static_cast<std::size_t>(told_++) % ring_.size()] = told;
  }
  news_.notify_all();
}

Focus FocusLine::next() {
  std::unique_lock lock(mutex_);
  const std::int64_t frame = live_ ? told_ - 1 : asked_ - kBehind;
  const std::int64_t pair = asked_++;
  if (pair % kWholeEvery == kFirstWhole || frame < 0) return {};
  news_.wait(lock, [&] { return closed_ || told_ > frame; });
  if (closed_ || pair == whole_pair_) return {};
  const Told& told = ring_[static_cast<std::size_t>(frame) % ring_.size()];
  return told.missed && pair % kMissedEvery == 0 ? Focus() : told.focus;
}

void FocusLine::forget() {
  const std::lock_guard lock(mutex_);
  if (!live_)
    whole_pair_ = told_ + kBehind;
  else if (told_ > 0)
    ring_[static_cast<std::size_t>(told_ - 1) % ring_.size()] = {};
}

void FocusLine::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  news_.notify_all();
}

}  // namespace duo
