// The fast CPU engine: one frame by all threads, or several at once by some each.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/object_pool.h"
#include "duoptic/bounded_queue.h"
#include "duoptic/worker.h"
#include "engines/engines.h"
#include "engines/simd_frames.h"

namespace duo {
namespace {

/// A thread that makes a frame while others make theirs.
class FrameThread {
 public:
  /// Errors  the system gives no thread
  static Result<std::unique_ptr<FrameThread>> start(const Prepared& prepared, int threads) {
    std::unique_ptr<FrameThread> out(new FrameThread(prepared, threads));
    DUO_TRY_ASSIGN(out->worker_, Worker::start(
                                     "make a frame", [p = out.get()](const std::stop_token&) { return p->make_all(); },
                                     [p = out.get()](const Result<void>& result) { p->done_.close(result); }));
    return out;
  }
  ~FrameThread() { jobs_.close(); }

  void submit(const Pair& pair, const std::vector<Window>& windows, const Focus& focus, std::uint64_t turn,
              std::shared_ptr<Frame> frame) {
    job_.pair = &pair;
    job_.turn = turn;
    job_.focus = focus;
    job_.windows = windows;
    job_.frame = std::move(frame);
    jobs_.put(job_);
  }
  std::shared_ptr<const Frame> collect() {
    std::shared_ptr<Frame> frame;
    DUO_CHECK(done_.take(frame));
    return frame;
  }

 private:
  struct Job {
    const Pair* pair = nullptr;
    std::vector<Window> windows;
    Focus focus;
    std::uint64_t turn = 0;
    std::shared_ptr<Frame> frame;
  };

  FrameThread(const Prepared& prepared, int threads) : frames_(prepared, threads) {}
  Result<void> make_all() {
    for (Job job;;) {
      DUO_TRY_ASSIGN(const Taken taken, jobs_.take(job));
      if (taken == Taken::kClosed) return {};
      frames_.make(*job.pair, job.windows, job.focus, job.turn, *job.frame);
      done_.put(job.frame);
    }
  }

  SimdFrames frames_;
  Job job_;  // on its way into the queue
  BoundedQueue<Job> jobs_{1, WhenFull::kWait};
  BoundedQueue<std::shared_ptr<Frame>> done_{1, WhenFull::kWait};
  Worker worker_;  // last: it uses all of the above
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
  int in_flight() const override { return std::max(1, static_cast<int>(threads_of_frames_.size())); }
  const std::optional<Rectified>& rectified() const override { return prepared_.geometry; }

  Result<void> prepare(const Setup& setup) override {
    DUO_TRY_ASSIGN(Prepared checked, prepare_setup(setup));
    const bool was_prepared = alone_ != nullptr || !threads_of_frames_.empty();
    rest();
    std::swap(prepared_, checked);
    const Result<void> made = make_frames();
    if (made) {
      focus_ = {};
      return {};
    }
    rest();
    std::swap(prepared_, checked);
    if (was_prepared) DUO_CHECK(make_frames());  // there was memory for that
    return made;
  }

  void look_at(std::span<const Window> windows) override { windows_.assign(windows.begin(), windows.end()); }
  void focus(const Focus& focus) override { focus_ = focus; }
  bool can_focus() const override { return !prepared_.match_color; }

  void submit(const Pair& pair) override {
    DUO_CHECK(prepared_.setup.size == pair.left.pixels.size() && prepared_.setup.size == pair.right.pixels.size());
    DUO_CHECK(count_ < in_flight());
    std::shared_ptr<Frame> frame = frames_.lend();
    if (alone_ != nullptr) {
      alone_->make(pair, windows_, focus_, turn_, *frame);
      frame_ = std::move(frame);
    } else {
      thread_of(first_ + count_).submit(pair, windows_, focus_, turn_, std::move(frame));
    }
    ++count_;
    ++turn_;
  }

  std::shared_ptr<const Frame> collect() override {
    DUO_CHECK(count_ > 0);
    --count_;
    if (alone_ != nullptr) return std::move(frame_);
    std::shared_ptr<const Frame> frame = thread_of(first_).collect();
    first_ = (first_ + 1) % in_flight();
    return frame;
  }

 private:
  /// What speaks of the last setup goes first: there need not be memory for both.
  void rest() {
    alone_.reset();
    threads_of_frames_.clear();
    frame_.reset();
    frames_ = {};
    first_ = count_ = 0;
  }
  Result<void> make_frames() {
    const int at_once = frames_at_once(prepared_.setup, threads_);
    prepared_.stream = std::make_shared<ClearStream>();  // a new one also where the last setup comes back
    turn_ = 0;
    if (at_once > 1) prepared_.setup.progress = {};
    try {
      for (int i = 0; at_once > 1 && i < at_once; ++i) {
        auto thread = FrameThread::start(prepared_, threads_ / at_once + (i < threads_ % at_once));
        if (!thread) break;  // fewer threads go on
        threads_of_frames_.push_back(std::move(*thread));
      }
      if (threads_of_frames_.empty()) alone_ = std::make_unique<SimdFrames>(prepared_, threads_);
      frames_ =
          ObjectPool<Frame>(static_cast<std::size_t>(in_flight() + kSpareFrames), [this] { return make_frame(prepared_); });
    } catch (const std::bad_alloc&) {
      const Setup& setup = prepared_.setup;
      return Error{ErrorCode::kExhausted,
                   fmt::format("cannot set up {}x{} pixels with {} disparities: out of memory; smaller pictures, fewer "
                               "disparities or fewer paths need less",
                               setup.size.width, setup.size.height, setup.max_disparity)};
    }
    return {};
  }

  FrameThread& thread_of(int frame) { return *threads_of_frames_[static_cast<std::size_t>(frame % in_flight())]; }

  const int threads_;
  Prepared prepared_;
  ObjectPool<Frame> frames_;
  std::unique_ptr<SimdFrames> alone_;                            // after what they refer to: either one that does all,
  std::vector<std::unique_ptr<FrameThread>> threads_of_frames_;  // or several that take turns
  std::shared_ptr<const Frame> frame_;                           // of alone_, until it is collected
  std::vector<Window> windows_;                                  // of the next submit
  Focus focus_;                                                  // likewise
  std::uint64_t turn_ = 0;                                       // likewise, since prepare()
  int first_ = 0, count_ = 0;                                    // in flight: count_ of them, the oldest in thread first_
};

}  // namespace

std::unique_ptr<Engine> make_simd_engine(int threads) { return std::make_unique<SimdEngine>(threads); }

}  // namespace duo
