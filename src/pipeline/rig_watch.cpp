#include "pipeline/rig_watch.h"

#include <chrono>
#include <string>
#include <utility>

#include "calib/rig_fitting.h"

namespace duo {
namespace {

constexpr char kWhat[] = "see whether the rig fits";
constexpr int kWatchedPairs = 3;
constexpr TimeNs kBetween_ns = 200'000'000, kSummed_ns = 600'000'000, kFirstCounts_ns = 100'000'000, kAllCount_ns = 800'000'000,
                 kAgain_ns = 60'000'000'000;

RigJudge judge_of_rig(const std::optional<Rig>& rig, Size size, SceneSearch most, bool still) {
  auto fitting = std::make_shared<RigFitting>(rig, size, 1, most, still);
  return {[fitting](const std::shared_ptr<const Pair>& first) { return fitting->by_first(first); },
          [fitting](std::span<const std::shared_ptr<const Pair>> others, const PairSum* sum) {
            return fitting->by_all(others, sum);
          },
          fitting->looks_at_sum() ? std::make_shared<PairSum>(size) : nullptr};
}

}  // namespace

RigWatch::RigWatch(std::optional<Rig> rig, bool live, bool still, bool quick)
    : RigWatch([rig = std::move(rig), still, most = quick ? SceneSearch::kQuick : SceneSearch::kThorough](
                   Size size) { return judge_of_rig(rig, size, most, still); },
               live) {}

const RigFit* RigWatch::see(const std::shared_ptr<const Pair>& pair, bool last) {
  if (!on_) return nullptr;
  if (!std::exchange(begun_, true)) begin(pair);
  const TimeNs since_ns = pair->left.t_ns - start_ns_;
  const bool gathers = step_ == Step::kFirst || step_ == Step::kGather;
  if (gathers && since_ns < kSummed_ns) add_to_sum(*pair);
  if (gathers && looked_at_ < kWatchedPairs && since_ns >= looked_at_ * kBetween_ns) {
    others_.push_back(pair);
    ++looked_at_;
  }
  const RigFit* const news = step(since_ns, last);
  if (live_ && step_ == Step::kDone && since_ns >= kAgain_ns) begun_ = false;
  return news;
}

void RigWatch::begin(const std::shared_ptr<const Pair>& pair) {
  start_ns_ = pair->left.t_ns;
  looked_at_ = 1;
  const auto made = without_exceptions(kWhat, [&]() -> Result<void> {
    judge_ = judge_of_(pair->left.pixels.size());
    return {};
  });
  start(Step::kFirst, [judge = made ? judge_.by_first : nullptr, pair] { return judge ? judge(pair) : RigFit(); });
}

/// Where it has no memory there is none.
void RigWatch::add_to_sum(const Pair& pair) {
  if (!judge_.sum) return;
  const auto added = without_exceptions(kWhat, [&]() -> Result<void> {
    judge_.sum->add(pair);
    return {};
  });
  if (!added) judge_.sum.reset();
}

const RigFit* RigWatch::end() { return step(0, true); }

/// As far as it goes without waiting; of files, where a pair is there by which it counts, further.
const RigFit* RigWatch::step(TimeNs since_ns, bool last) {
  const auto counts = [&](TimeNs from_ns) { return last || (!live_ && since_ns >= from_ns); };
  const RigFit* news = nullptr;
  if (step_ == Step::kFirst && (counts(kFirstCounts_ns) || ended())) news = take(kFirstCounts_ns);
  const bool gathered = since_ns >= (looked_at_ == kWatchedPairs ? kSummed_ns : kAllCount_ns);
  if (step_ == Step::kGather && (last || gathered)) start_all();
  if (step_ == Step::kAll && (counts(kAllCount_ns) || ended())) news = take(kAllCount_ns);
  if (step_ == Step::kKnown && (live_ || counts(counts_from_ns_))) {
    fit_ = **found_;
    step_ = Step::kDone;
  }
  return news;
}

void RigWatch::start_all() {
  start(Step::kAll, [judge = judge_.by_all, others = std::move(others_), sum = judge_.sum] {
    return std::optional(judge(others, sum.get()));
  });
}

void RigWatch::start(Step step, std::function<std::optional<RigFit>()> judge) {
  step_ = step;
  found_ = std::make_shared<std::optional<RigFit>>();
  const auto work = [found = found_, judge = std::move(judge)](const std::stop_token&) -> Result<void> {
    *found = judge();
    return {};
  };
  if (auto worker = Worker::start(kWhat, work))
    worker_ = std::move(*worker);
  else if (!without_exceptions(kWhat, [&] { return work({}); }))
    *found_ = RigFit();
}

bool RigWatch::ended() const { return !worker_.started() || worker_.ends_within(std::chrono::nanoseconds(0)); }

/// What the worker found, where it is another verdict than was told.
const RigFit* RigWatch::take(TimeNs counts_from_ns) {
  const bool by_first = step_ == Step::kFirst;
  if (worker_.started() && !std::exchange(worker_, {}).join()) *found_ = RigFit();  // it had no memory: nothing is found
  step_ = by_first && !*found_ ? Step::kGather : Step::kKnown;
  if (step_ == Step::kGather) return nullptr;
  others_.clear();
  judge_ = {};
  counts_from_ns_ = counts_from_ns;
  const RigFit& found = **found_;
  return std::exchange(told_, found.verdict) == found.verdict ? nullptr : &found;
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
