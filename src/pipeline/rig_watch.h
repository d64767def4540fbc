// Whether the rig fits, looked at beside a run.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "calib/scene_patches.h"
#include "duoptic/person.h"
#include "duoptic/rig_fit.h"
#include "duoptic/worker.h"

namespace duo {

/// The two steps of RigFitting.
struct RigJudge {
  std::function<std::optional<RigFit>(const std::shared_ptr<const Pair>& first)> by_first;
  std::function<RigFit(std::span<const std::shared_ptr<const Pair>> others, const PairSum* sum)> by_all;
  std::shared_ptr<PairSum> sum;  // for by_all, still empty; null: it looks at none
};

/// Judges by the first pair, and where that leaves a doubt by it and two that come 0.2 and 0.4 s later, and by the sum of all
/// in 0.6 s, in a thread of its own; of a live source again every minute. Where pairs are rare it waits for both of these until
/// 0.8 s. What it finds is news as soon as the thread has ended. Of files it counts from the same pair on in every run: the
/// first that comes 0.1 s, or 0.8 s, after the first, or the end. Where the system gives no thread the caller's judges; where
/// it gives no memory nothing is found.
///
/// Threads  one caller
class RigWatch {
 public:
  RigWatch() = default;  // looks at nothing
  /// `still`: one pair of photos. `quick`: by few points in any case, for who has little else to do; a rig in front of bare
  /// walls may not be judged then.
  RigWatch(std::optional<Rig> rig, bool live, bool still = false, bool quick = false);
  /// `judge_of`: a judge of pictures of that size.
  RigWatch(std::function<RigJudge(Size)> judge_of, bool live) : judge_of_(std::move(judge_of)), on_(true), live_(live) {}

  /// The next pair; `last`: no other will come. What is news by it; null: nothing.
  const RigFit* see(const std::shared_ptr<const Pair>& pair, bool last);
  /// No pair will come.
  const RigFit* end();

  /// Of files: whether further pairs change nothing.
  bool settled() const { return !on_ || fit_.has_value(); }
  /// What counts. Empty until pairs were judged.
  const std::optional<RigFit>& fit() const { return fit_; }

 private:
  /// What is judged, waited for, or known without counting yet.
  enum class Step : std::uint8_t { kFirst, kGather, kAll, kKnown, kDone };

  void begin(const std::shared_ptr<const Pair>& pair);
  void add_to_sum(const Pair& pair);
  void start(Step step, std::function<std::optional<RigFit>()> judge);
  void start_all();
  bool ended() const;
  const RigFit* take(TimeNs counts_from_ns);
  const RigFit* step(TimeNs since_ns, bool last);

  std::function<RigJudge(Size)> judge_of_;
  bool on_ = false, live_ = false;
  Step step_ = Step::kDone;
  bool begun_ = false;                        // with these pairs
  TimeNs start_ns_ = 0, counts_from_ns_ = 0;  // of the first of them; after it, what is known
  int looked_at_ = 0;                         // of them
  RigJudge judge_;
  std::vector<std::shared_ptr<const Pair>> others_;
  std::optional<RigFit> fit_;
  std::optional<RigVerdict> told_;
  std::shared_ptr<std::optional<RigFit>> found_;  // the worker's
  Worker worker_;                                 // last: it uses all of the above
};

/// What disparities are off by everywhere makes every joint's place along its ray less sure.
void widen(std::span<Person> people, const Rectified& rectified, double disparity_sigma_px);

}  // namespace duo
