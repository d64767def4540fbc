#include "sources/live/live_pairs.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <utility>

#include "core/check.h"
#include "duoptic/bounded_queue.h"
#include "duoptic/worker.h"
#include "sources/pairing.h"

namespace duo {
namespace {

class LivePairs final : public PairSource {
 public:
  LivePairs(std::unique_ptr<Source> left, std::unique_ptr<Source> right)
      : sources_{std::move(left), std::move(right)}, pairing_({sources_[0]->frame_s(), sources_[1]->frame_s()}) {}

  Result<void> start() {
    for (const CameraSide side : {CameraSide::kLeft, CameraSide::kRight}) {
      DUO_TRY_ASSIGN(readers_[static_cast<std::size_t>(side)],
                     Worker::start(
                         "take the next picture", [this, side](const std::stop_token& stop) { return read(side, stop); },
                         [this](const Result<void>& result) { pairs_.close(result); }));
    }
    return {};
  }

  ~LivePairs() override {
    for (Worker& reader : readers_) reader.ask_to_stop();  // both at once: each may have to wait for its camera
  }

  Size size() const override { return sources_[0]->size(); }
  std::int64_t count() const override { return 0; }
  bool still() const override { return false; }
  double frame_s() const override { return std::max(sources_[0]->frame_s(), sources_[1]->frame_s()); }
  bool live() const override { return true; }
  std::int64_t dropped() const override { return pairs_.dropped(); }
  std::string warning() const override {
    const std::string left = sources_[0]->warning(), right = sources_[1]->warning();
    return left + (left.empty() || right.empty() ? "" : "; ") + right;
  }

  Result<Next> next(Pair& into) override {
    DUO_TRY_ASSIGN(const Taken taken, pairs_.take(into, std::chrono::milliseconds(500)));
    if (taken == Taken::kClosed) return end_.load();
    return taken == Taken::kValue ? Next::kNew : Next::kNothing;
  }

 private:
  /// Until one of both ends.
  Result<void> read(CameraSide side, const std::stop_token& stop) {
    Source& source = *sources_[static_cast<std::size_t>(side)];
    Picture picture;
    while (!stop.stop_requested()) {
      DUO_TRY_ASSIGN(const Next next, source.next(picture));
      if (next == Next::kNothing) continue;
      if (next != Next::kNew) {
        end_ = next;
        break;
      }
      const std::lock_guard lock(mutex_);
      pairing_.put(side, picture);
      if (!give()) break;
    }
    return {};
  }

  /// What can be paired now; false where nobody takes pairs any more.
  bool give() {
    while (true) {
      const Pairing::Step step = pairing_.step(paired_);
      if (step == Pairing::Step::kMore) return true;
      if (step == Pairing::Step::kPair && !pairs_.put(paired_)) return false;
    }
  }

  const std::array<std::unique_ptr<Source>, 2> sources_;
  BoundedQueue<Pair> pairs_{1, WhenFull::kDropOldest};
  std::atomic<Next> end_ = Next::kEnd;
  std::mutex mutex_;  // of what follows
  Pairing pairing_;
  Pair paired_;                    // on its way from pairing_ to pairs_
  std::array<Worker, 2> readers_;  // last: they use all of the above
};

}  // namespace

Result<std::unique_ptr<PairSource>> make_live_pairs(std::unique_ptr<Source> left, std::unique_ptr<Source> right) {
  DUO_CHECK(left->live() && right->live() && left->size() == right->size());
  auto pairs = std::make_unique<LivePairs>(std::move(left), std::move(right));
  DUO_TRY(pairs->start());
  return std::unique_ptr<PairSource>(std::move(pairs));
}

}  // namespace duo
