// Pairs of a source as frames of an engine, made ahead of who takes them.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/object_pool.h"
#include "duoptic/bounded_queue.h"
#include "duoptic/engine.h"
#include "duoptic/source.h"
#include "duoptic/worker.h"
#include "pipeline/cpu_budget.h"
#include "pipeline/focus_line.h"
#include "stages/align_time/align_time.h"

namespace duo {

/// A pair and what an engine made of it.
struct Matched {
  std::shared_ptr<Pair> pair;  // as it came
  std::shared_ptr<const Frame> frame;
  double engine_ms = 0;     // from when the engine was given the pair to its frame
  std::string event;        // Engine::take_event()
  bool aligned = false;     // the engine got another right picture, that of the left one's capture time:
  Image<Rgb8> other_right;  // it lies here, and while the engine works on the pair it is the one that came that lies here
  std::int64_t started_ns = 0;
  Focus focus;    // of the engine, where the stream has a line of them
  int setup = 0;  // which of the stream's setups the frame was made with
};

/// Source → align in time → engine, in threads. Of files each pair is read and matched in order; a live source gives its newest
/// pair when the engine is free. Two frames of files wait for who takes them, of a live source one; meanwhile matching rests.
class FrameStream {
 public:
  /// Pairs before number `first` are passed over, and of those from there on all but every `every`-th; of a live source also
  /// those that would take more CPU time per wall time than `cores`, where that is not 0.
  struct Choice {
    std::int64_t first = 0, every = 1;
    double cores = 0;
  };
  /// What the source gave already.
  struct Passed {
    std::int64_t pairs = 0;
    TimeNs start_ns = 0;              // of the first
    std::shared_ptr<Pair> last = {};  // the one before the next, where there is one
  };
  /// The engine, which must be prepared and outlive this, gets `at_once` pairs at once, of a live source one. Null: the pairs
  /// come without frames. `focus` says what of each pair the engine shall match, and may be null; it must outlive this, and is
  /// closed at its end.
  FrameStream(std::unique_ptr<PairSource> source, Engine* engine, int at_once, Choice choice, Passed passed,
              FocusLine* focus = nullptr);
  ~FrameStream();
  FrameStream(const FrameStream&) = delete;
  FrameStream& operator=(const FrameStream&) = delete;

  /// Starts the threads. What a thread that the system refuses would do, next() does: the frames are the same.
  void start();

  /// As PairSource::next(); only a picture changes `into`. Not to be called again after the end or an error.
  Result<Next> next(Matched& into);
  /// Until the next frame, or the end, is ready; of one pair at once matching rests then.
  void wait() {
    if (matcher_.started()) frames_.wait();
  }
  /// Another setup for the engine. `last` and the frames that follow are made with it.
  ///
  /// Errors  those of Engine::prepare(); then all is as it was
  Result<void> prepare(const Setup& setup, Matched& last);

  const PairSource& source() const { return *source_; }
  TimeNs start_ns() const { return start_ns_; }        // of the source's first pair, once next() gave one
  std::int64_t read() const { return read_; }          // pairs of the source, before its end
  std::int64_t left_out() const { return left_out_; }  // of them, for Choice::cores

 private:
  Result<void> read_all();
  Result<void> match_all(const std::stop_token& stop);
  /// kNothing where a live source has none yet.
  Result<Next> make_next(Matched& item);
  Result<Next> take_frame();
  Result<Next> read_pair(std::shared_ptr<Pair>& into);
  Result<Next> take_pair(std::shared_ptr<Pair>& into);
  Result<Next> choose_pair(std::shared_ptr<Pair>& into);
  void align(Matched& item);
  void submit(Matched& item);
  void collect(Matched& item);
  void make_anew(Matched& item);
  void empty_engine();
  void refill_engine();
  Matched& in_flight(std::size_t i) { return ring_[(oldest_ + i) % ring_.size()]; }

  std::unique_ptr<PairSource> source_;
  Engine* const engine_;
  FocusLine* const focus_;
  const Choice choice_;
  CpuBudget budget_;
  ObjectPool<Pair> pool_;
  ref::AlignTime align_;
  std::atomic<std::int64_t> read_ = 0, left_out_ = 0;
  std::atomic<TimeNs> start_ns_ = 0;
  std::int64_t pairs_read_ = 0;               // of whichever thread reads
  std::shared_ptr<Pair> before_;              // of files, the pair before the one that is aligned
  std::optional<Result<Next>> end_of_pairs_;  // of the matching thread alone
  std::atomic<Next> end_ = Next::kEnd;        // what the source's was

  std::mutex engine_mutex_;  // of what follows
  std::vector<Matched> ring_;
  std::size_t oldest_ = 0, in_engine_ = 0;  // in_engine_ of ring_ from oldest_
  int setup_ = 0;

  BoundedQueue<std::shared_ptr<Pair>> pairs_{1, WhenFull::kWait};  // of files
  BoundedQueue<Matched> frames_;
  Matched taken_;            // on its way out of the queue
  Worker reader_, matcher_;  // last: they use all of the above
};

}  // namespace duo
