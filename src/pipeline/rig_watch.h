// Whether the rig fits, looked at beside a run.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "calib/rig_fitting.h"
#include "duoptic/person.h"
#include "duoptic/rig_fit.h"
#include "duoptic/worker.h"

namespace duo {

/// Judges by the first pair, and where that leaves a doubt by three pairs of the first second, in a thread of its own; of a
/// live source again every minute. Of files what it finds is there from the same pair on in every run: the first that comes 0.1
/// s, or 0.9 s, after the first, or the end. Where the system gives no thread the caller's judges; where it gives no memory
/// nothing is found.
///
/// Threads  one caller
class RigWatch {
 public:
  RigWatch() = default;  // looks at nothing
  RigWatch(std::optional<Rig> rig, bool live) : rig_(std::move(rig)), on_(true), live_(live) {}

  /// The next pair; `last`: no other will come. Whether fit() is new by it.
  bool see(const std::shared_ptr<const Pair>& pair, bool last);
  /// No pair will come. Whether fit() is new by it.
  bool end();

  /// Of files: whether further pairs change nothing.
  bool settled() const { return !on_ || fit_.has_value(); }
  /// Empty until pairs were judged.
  const std::optional<RigFit>& fit() const { return fit_; }

 private:
  /// What is judged, or waited for.
  enum class Step : std::uint8_t { kFirst, kGather, kAll, kDone };

  void start(Step step, std::function<std::optional<RigFit>()> judge);
  void start_all();
  bool is_known(TimeNs since_ns, TimeNs of_files_ns);
  bool take();

  std::optional<Rig> rig_;
  bool on_ = false, live_ = false;
  Step step_ = Step::kDone;
  bool begun_ = false;                   // with these pairs
  TimeNs start_ns_ = 0;                  // of the first of them
  int looked_at_ = 0;                    // of them
  std::shared_ptr<RigFitting> fitting_;  // the worker's, too
  std::vector<std::shared_ptr<const Pair>> others_;
  std::optional<RigFit> fit_;
  std::shared_ptr<std::optional<RigFit>> found_;  // the worker's
  Worker worker_;                                 // last: it uses all of the above
};

/// What disparities are off by everywhere makes every joint's place along its ray less sure.
void widen(std::span<Person> people, const Rectified& rectified, double disparity_sigma_px);

}  // namespace duo
