#include "pipeline/rig_watch.h"

#include <chrono>
#include <string>
#include <utility>

namespace duo {
namespace {

constexpr std::size_t kWatchedPairs = 3;
constexpr TimeNs kBetween_ns = 300'000'000, kKnown_ns = 900'000'000, kAgain_ns = 60'000'000'000;

}  // namespace

bool RigWatch::see(const std::shared_ptr<const Pair>& pair, bool last) {
  if (!on_) return false;
  if (pairs_.empty() && !started_) start_ns_ = pair->left.t_ns;
  const TimeNs since_ns = pair->left.t_ns - start_ns_;
  if (!started_) {
    if (since_ns >= static_cast<TimeNs>(pairs_.size()) * kBetween_ns) pairs_.push_back(pair);
    if (pairs_.size() == kWatchedPairs || since_ns >= kKnown_ns || last) start();
  }
  if (last || (!live_ && since_ns >= kKnown_ns)) return take();
  if (!live_) return false;
  if (since_ns >= kAgain_ns && !waiting_) started_ = false;
  return waiting_ && (!worker_.started() || worker_.ends_within(std::chrono::nanoseconds(0))) && take();
}

bool RigWatch::end() {
  if (!started_ && !pairs_.empty()) start();
  return take();
}

void RigWatch::start() {
  started_ = waiting_ = true;
  found_ = std::make_shared<RigFit>();
  const auto work = [found = found_, rig = rig_, pairs = std::exchange(pairs_, {})](const std::stop_token&) -> Result<void> {
    *found = rig_fit(rig, pairs, 1);
    return {};
  };
  const std::string what = "see whether the rig fits";
  if (auto worker = Worker::start(what, work))
    worker_ = std::move(*worker);
  else
    static_cast<void>(without_exceptions(what, [&] { return work({}); }));
}

bool RigWatch::take() {
  if (!std::exchange(waiting_, false)) return false;
  if (worker_.started() && !std::exchange(worker_, {}).join()) *found_ = {};
  const bool news = !fit_ || fit_->verdict != found_->verdict;
  fit_ = std::move(*found_);
  return news;
}

void widen(std::span<Person> people, const Rectified& rectified, double disparity_sigma_px) {
  for (Person& person : people)
    for (std::size_t j = 0; j < person.count(); ++j) {
      Joint& joint = person.joints[j];
      if (joint.state == JointState::kLost || joint.p_in_rig_m.z <= 0) continue;
      const Vec3 p = joint.p_in_rig_m;
      const double per_z = disparity_sigma_px * p.z / (rectified.focal_px * rectified.baseline_m);  // dp = p dz / z
      const Vec3 off = per_z * p;
      Covariance3& c = joint.cov_m2;
      c.xx += off.x * off.x, c.xy += off.x * off.y, c.xz += off.x * off.z;
      c.yy += off.y * off.y, c.yz += off.y * off.z, c.zz += off.z * off.z;
    }
}

}  // namespace duo
