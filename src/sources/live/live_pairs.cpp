#include "sources/live/live_pairs.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <new>
#include <optional>
#include <thread>
#include <utility>

#include "core/check.h"
#include "sources/live/pairing.h"

namespace duo {
namespace {

class LivePairs final : public PairSource {
 public:
  LivePairs(std::unique_ptr<Source> left, std::unique_ptr<Source> right)
      : sources_{std::move(left), std::move(right)},
        pairing_(std::min(sources_[0]->frame_s(), sources_[1]->frame_s())),
        threads_{std::thread([this] { run(CameraSide::kLeft); }), std::thread([this] { run(CameraSide::kRight); })} {}
  ~LivePairs() override {
    stopped_ = true;
    for (std::thread& thread : threads_) thread.join();
  }

  Size size() const override { return sources_[0]->size(); }
  std::int64_t count() const override { return 0; }
  bool still() const override { return false; }
  double frame_s() const override { return std::max(sources_[0]->frame_s(), sources_[1]->frame_s()); }
  bool live() const override { return true; }
  std::int64_t dropped() const override {
    const std::lock_guard lock(mutex_);
    return pairing_.dropped();
  }
  std::string warning() const override {
    const std::string left = sources_[0]->warning(), right = sources_[1]->warning();
    return left + (left.empty() || right.empty() ? "" : "; ") + right;
  }

  Result<Next> next(Pair& into) override {
    constexpr auto kPatience = std::chrono::milliseconds(500);
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kPatience, [this] { return pairing_.ready() || ended_; });
    if (pairing_.ready()) {
      pairing_.take(into);
      return Next::kPicture;
    }
    if (ended_) return *ended_;
    return Next::kNothing;
  }

 private:
  void run(CameraSide side) {
    Source& source = *sources_[static_cast<std::size_t>(side)];
    Picture picture;
    while (!stopped_) {
      Result<Next> next = next_of(source, picture);
      if (next && *next == Next::kNothing) continue;
      const std::lock_guard lock(mutex_);
      if (next && *next == Next::kPicture)
        pairing_.add(side, picture);
      else
        ended_ = std::move(next);
      changed_.notify_all();
      if (ended_) return;
    }
  }

  /// Nothing may be thrown out of a thread.
  static Result<Next> next_of(Source& source, Picture& picture) {
    try {
      return source.next(picture);
    } catch (const std::bad_alloc&) {
      return Error{ErrorCode::kUnsupported, "cannot take the next picture: out of memory; smaller pictures need less"};
    }
  }

  const std::array<std::unique_ptr<Source>, 2> sources_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Pairing pairing_;
  std::optional<Result<Next>> ended_;  // an end or an error of either
  std::atomic<bool> stopped_ = false;
  std::array<std::thread, 2> threads_;  // last: they use all of the above
};

}  // namespace

std::unique_ptr<PairSource> make_live_pairs(std::unique_ptr<Source> left, std::unique_ptr<Source> right) {
  DUO_CHECK(left->live() && right->live() && left->size() == right->size());
  return std::make_unique<LivePairs>(std::move(left), std::move(right));
}

}  // namespace duo
