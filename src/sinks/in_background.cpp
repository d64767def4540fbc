// in_background(): a queue before a sink.
#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <new>
#include <thread>
#include <utility>
#include <vector>

#include "duoptic/sink.h"

namespace duo {
namespace {

/// A TrackedFrame's data, kept after write(); its memory is used again.
struct KeptFrame {
  std::int64_t number = 0;
  double t_s = 0;
  Picture left;
  Frame frame;
  std::vector<Person> people;
  std::optional<TrackTimes> times;

  void keep(const TrackedFrame& from, bool pictures) {
    number = from.number;
    t_s = from.t_s;
    people.assign(from.people.begin(), from.people.end());
    times = from.times;
    left.t_ns = from.left.t_ns;
    left.sequence = from.left.sequence;
    frame.sequence = from.frame.sequence;
    frame.t_ns = from.frame.t_ns;
    frame.skew_ns = from.frame.skew_ns;
    if (!pictures) return;
    copy(from.left.pixels, left.pixels);
    copy(from.frame.color, frame.color);
    copy(from.frame.disparity.d_q4, frame.disparity.d_q4);
    copy(from.frame.disparity.origin, frame.disparity.origin);
  }
  TrackedFrame view() const { return {number, t_s, left, frame, people, times}; }

 private:
  template <class T>
  static void copy(const Image<T>& from, Image<T>& to) {
    if (to.size() != from.size()) to = Image<T>(from.size());
    for (int y = 0; y < from.height(); ++y) std::copy_n(from.row(y), from.width(), to.row(y));
  }
};

class InBackground final : public Sink {
 public:
  explicit InBackground(std::unique_ptr<Sink> sink)
      : sink_(std::move(sink)), queue_(sink_->wants_pictures() ? 4 : 60), thread_([this] { write_all(); }) {}
  ~InBackground() override { stop(); }

  Result<void> write(const TrackedFrame& frame) override {
    {
      const std::lock_guard lock(mutex_);
      if (!state_) return state_;
      if (waiting_ == queue_.size()) {
        first_ = (first_ + 1) % queue_.size();
        --waiting_;
        ++dropped_;
      }
      queue_[(first_ + waiting_) % queue_.size()].keep(frame, sink_->wants_pictures());
      ++waiting_;
    }
    changed_.notify_one();
    return {};
  }
  std::int64_t dropped() const override {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }
  /// Waits for the frame that is being written and those behind it.
  Result<void> finish() override {
    stop();
    DUO_TRY(state_);
    return sink_->finish();
  }

 private:
  void stop() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    changed_.notify_one();
    if (thread_.joinable()) thread_.join();
  }

  void write_all() {
    KeptFrame taken;
    std::unique_lock lock(mutex_);
    while (state_) {
      changed_.wait(lock, [this] { return waiting_ > 0 || stopped_; });
      if (waiting_ == 0) return;
      std::swap(taken, queue_[first_]);
      first_ = (first_ + 1) % queue_.size();
      --waiting_;
      lock.unlock();
      Result<void> written = write(*sink_, taken);
      lock.lock();
      state_ = std::move(written);
    }
  }

  /// Nothing may be thrown out of a thread.
  static Result<void> write(Sink& sink, const KeptFrame& frame) {
    try {
      return sink.write(frame.view());
    } catch (const std::bad_alloc&) {
      return Error{ErrorCode::kUnsupported, "cannot write a frame: out of memory; smaller pictures need less"};
    }
  }

  std::unique_ptr<Sink> sink_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<KeptFrame> queue_;  // a ring
  std::size_t first_ = 0, waiting_ = 0;
  bool stopped_ = false;
  std::int64_t dropped_ = 0;
  Result<void> state_;  // of the last frame written
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace

std::unique_ptr<Sink> in_background(std::unique_ptr<Sink> sink) { return std::make_unique<InBackground>(std::move(sink)); }

}  // namespace duo
