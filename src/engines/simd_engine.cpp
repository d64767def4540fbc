// The fast CPU engine: one frame by all threads, or several at once by some each.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <new>
#include <thread>
#include <utility>
#include <vector>

#include "core/check.h"
#include "engines/engines.h"
#include "engines/simd_frames.h"

namespace duo {
namespace {

/// A thread that makes a frame while others make theirs.
class Lane {
 public:
  Lane(const Prepared& prepared, int threads) : frames_(prepared, threads), thread_([this] { make_all(); }) {}
  ~Lane() {
    state_.wait(State::kMake);
    tell(State::kStop);
    thread_.join();
  }

  void submit(const Pair& pair, const std::vector<Window>& windows) {
    pair_ = &pair;
    windows_ = windows;
    tell(State::kMake);
  }
  const Frame& collect() {
    state_.wait(State::kMake);
    return *frame_;
  }

 private:
  enum class State { kRest, kMake, kStop };
  void tell(State state) {
    state_ = state;
    state_.notify_all();
  }
  void make_all() {
    for (;;) {
      state_.wait(State::kRest);
      if (state_ == State::kStop) return;
      frame_ = &frames_.make(*pair_, windows_);
      tell(State::kRest);
    }
  }

  SimdFrames frames_;
  const Pair* pair_ = nullptr;  // these are the thread's from kMake to kRest
  std::vector<Window> windows_;
  const Frame* frame_ = nullptr;
  std::atomic<State> state_ = State::kRest;
  std::thread thread_;  // last: it uses all of the above
};

/// Threads that share a frame wait for each other's rows; those with frames of their own do not, but each frame takes longer,
/// and memory of its own. Beyond four frames that memory is more than what they gain.
int frames_at_once(const Setup& setup, int threads) {
  constexpr int kMost = 4;
  return setup.many_at_once ? std::min(threads, kMost) : 1;
}

class SimdEngine final : public Engine {
 public:
  explicit SimdEngine(int threads) : threads_(threads) {}

  const char* name() const override { return "simd"; }
  int in_flight() const override { return std::max(1, static_cast<int>(lanes_.size())); }
  const std::optional<Rectified>& rectified() const override { return prepared_.geometry; }

  Result<void> prepare(const Setup& setup) override {
    DUO_TRY_ASSIGN(Prepared checked, prepare_setup(setup));
    const bool was_prepared = alone_ != nullptr || !lanes_.empty();
    rest();
    std::swap(prepared_, checked);
    try {
      make_frames();
    } catch (const std::bad_alloc&) {
      rest();
      std::swap(prepared_, checked);
      if (was_prepared) make_frames();  // there was memory for that
      return Error{ErrorCode::kExhausted,
                   fmt::format("cannot set up {}x{} pixels with {} disparities: out of memory; smaller pictures, fewer "
                               "disparities or fewer paths need less",
                               setup.size.width, setup.size.height, setup.max_disparity)};
    }
    return {};
  }

  void look_at(std::span<const Window> windows) override { windows_.assign(windows.begin(), windows.end()); }

  void submit(const Pair& pair) override {
    DUO_CHECK(prepared_.setup.size == pair.left.pixels.size() && prepared_.setup.size == pair.right.pixels.size());
    DUO_CHECK(count_ < in_flight());
    if (alone_ != nullptr)
      frame_ = &alone_->make(pair, windows_);
    else
      lane(first_ + count_).submit(pair, windows_);
    ++count_;
  }

  const Frame& collect() override {
    DUO_CHECK(count_ > 0);
    --count_;
    if (alone_ != nullptr) return *frame_;
    const Frame& frame = lane(first_).collect();
    first_ = (first_ + 1) % in_flight();
    return frame;
  }

 private:
  /// What speaks of the last setup goes first: there need not be memory for both.
  void rest() {
    alone_.reset();
    lanes_.clear();
    first_ = count_ = 0;
  }
  void make_frames() {
    const int at_once = frames_at_once(prepared_.setup, threads_);
    if (at_once == 1) {
      alone_ = std::make_unique<SimdFrames>(prepared_, threads_);
    } else {
      for (int i = 0; i < at_once; ++i)
        lanes_.push_back(std::make_unique<Lane>(prepared_, threads_ / at_once + (i < threads_ % at_once)));
    }
  }

  Lane& lane(int frame) { return *lanes_[static_cast<std::size_t>(frame % in_flight())]; }

  const int threads_;
  Prepared prepared_;
  std::unique_ptr<SimdFrames> alone_;         // after what they refer to: either one that does all,
  std::vector<std::unique_ptr<Lane>> lanes_;  // or several that take turns
  const Frame* frame_ = nullptr;
  std::vector<Window> windows_;  // of the next submit
  int first_ = 0, count_ = 0;    // in flight: count_ of them, the oldest in lane first_
};

}  // namespace

std::unique_ptr<Engine> make_simd_engine(int threads) { return std::make_unique<SimdEngine>(threads); }

}  // namespace duo
