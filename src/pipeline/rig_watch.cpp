#include "pipeline/rig_watch.h"

#include <chrono>
#include <string>
#include <utility>

namespace duo {
namespace {

constexpr int kWatchedPairs = 3;
constexpr TimeNs kBetween_ns = 300'000'000, kFirstKnown_ns = 100'000'000, kKnown_ns = 900'000'000, kAgain_ns = 60'000'000'000;

}  // namespace

bool RigWatch::see(const std::shared_ptr<const Pair>& pair, bool last) {
  if (!on_) return false;
  if (!std::exchange(begun_, true)) {
    start_ns_ = pair->left.t_ns;
    looked_at_ = 1;
    fitting_ = std::make_shared<RigFitting>(rig_, pair->left.pixels.size(), 1);
    start(Step::kFirst, [fitting = fitting_, pair] { return fitting->by_first(pair); });
  }
  const TimeNs since_ns = pair->left.t_ns - start_ns_;
  const bool gathers = step_ == Step::kFirst || step_ == Step::kGather;
  if (gathers && looked_at_ < kWatchedPairs && since_ns >= looked_at_ * kBetween_ns) {
    others_.push_back(pair);
    ++looked_at_;
  }
  if (step_ == Step::kFirst && (last || is_known(since_ns, kFirstKnown_ns)) && take()) return true;
  if (step_ == Step::kGather && (last || looked_at_ == kWatchedPairs || since_ns >= kKnown_ns)) start_all();
  if (step_ == Step::kAll && (last || is_known(since_ns, kKnown_ns))) return take();
  if (live_ && step_ == Step::kDone && since_ns >= kAgain_ns) begun_ = false;
  return false;
}

bool RigWatch::end() {
  if (step_ == Step::kFirst && take()) return true;
  if (step_ == Step::kGather) start_all();
  return step_ == Step::kAll && take();
}

void RigWatch::start_all() {
  start(Step::kAll, [fitting = fitting_, others = std::move(others_)] { return std::optional(fitting->by_all(others)); });
}

void RigWatch::start(Step step, std::function<std::optional<RigFit>()> judge) {
  step_ = step;
  found_ = std::make_shared<std::optional<RigFit>>();
  const auto work = [found = found_, judge = std::move(judge)](const std::stop_token&) -> Result<void> {
    *found = judge();
    return {};
  };
  const std::string what = "see whether the rig fits";
  if (auto worker = Worker::start(what, work))
    worker_ = std::move(*worker);
  else if (!without_exceptions(what, [&] { return work({}); }))
    *found_ = RigFit();
}

/// Whether what the worker found counts from now on.
bool RigWatch::is_known(TimeNs since_ns, TimeNs of_files_ns) {
  return live_ ? !worker_.started() || worker_.ends_within(std::chrono::nanoseconds(0)) : since_ns >= of_files_ns;
}

/// What the worker found. Whether it is news.
bool RigWatch::take() {
  const bool by_first = step_ == Step::kFirst;
  if (worker_.started() && !std::exchange(worker_, {}).join()) *found_ = RigFit();  // it had no memory: nothing is found
  step_ = by_first && !*found_ ? Step::kGather : Step::kDone;
  if (step_ == Step::kGather) return false;
  others_.clear();
  fitting_.reset();
  const RigFit found = found_->value_or(RigFit());
  const bool news = !fit_ || fit_->verdict != found.verdict;
  fit_ = found;
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
