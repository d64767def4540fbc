#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include "core/clock.h"
#include "duoptic/source.h"

namespace duo {
namespace {

class InRealTime final : public PairSource {
 public:
  explicit InRealTime(std::unique_ptr<PairSource> pairs) : pairs_(std::move(pairs)) {}
  Size size() const override { return pairs_->size(); }
  std::int64_t count() const override { return pairs_->count(); }
  bool still() const override { return pairs_->still(); }
  double frame_s() const override { return pairs_->frame_s(); }
  std::optional<Rig> rig() const override { return pairs_->rig(); }
  bool live() const override { return true; }
  std::int64_t dropped() const override { return dropped_; }
  std::string warning() const override { return pairs_->warning(); }

  Result<Next> next(Pair& into) override {
    if (!ahead_) {
      DUO_TRY_ASSIGN(ahead_, pairs_->next(next_));
      if (*ahead_ == Next::kNew) file_start_ns_ = next_.left.t_ns, start_ns_ = wall_ns();
    }
    if (*ahead_ != Next::kNew) return *ahead_;
    wait_until_due();
    if (!due()) return Next::kNothing;
    do {
      std::swap(into, next_);
      DUO_TRY_ASSIGN(ahead_, pairs_->next(next_));
    } while (*ahead_ == Next::kNew && due() && ++dropped_);
    into.left.t_ns += start_ns_ - file_start_ns_;
    into.right.t_ns += start_ns_ - file_start_ns_;
    return Next::kNew;
  }

 private:
  TimeNs due_ns() const { return start_ns_ + next_.left.t_ns - file_start_ns_; }
  bool due() const { return wall_ns() >= due_ns(); }
  void wait_until_due() const {
    constexpr TimeNs kLongest = 500'000'000;  // who asks may want to stop
    const TimeNs wait_ns = std::min(due_ns() - wall_ns(), kLongest);
    if (wait_ns > 0) std::this_thread::sleep_for(std::chrono::nanoseconds(wait_ns));
  }

  std::unique_ptr<PairSource> pairs_;
  Pair next_;                  // the one to come, when there is one
  std::optional<Next> ahead_;  // what became of it
  TimeNs file_start_ns_ = 0, start_ns_ = 0;
  std::atomic<std::int64_t> dropped_ = 0;
};

}  // namespace

std::unique_ptr<PairSource> in_real_time(std::unique_ptr<PairSource> pairs) {
  return std::make_unique<InRealTime>(std::move(pairs));
}

}  // namespace duo
