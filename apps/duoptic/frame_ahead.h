// Reads the pairs of a clip and makes frames of them ahead of who takes them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ahead.h"
#include "duoptic/engine.h"
#include "duoptic/in_step.h"
#include "timing.h"

namespace duo::app {

/// A pair and the frame that an engine made of it.
struct Matched {
  Pair pair;
  const Frame* frame = nullptr;
  double engine_ms = 0;  // from when the engine was given the pair to its frame
  std::string event;     // Engine::take_event()
  // The right picture as the engine had it, put to the left one's moment; while the engine has it, the one that came.
  bool in_step = false;
  Image<Rgb8> other_right;
};

/// Pairs through an engine, one frame ahead and `at_once` in the engine; files are read one pair ahead of that. A live source
/// gives its newest pair when the engine is free.
class FrameAhead {
 public:
  /// Pairs before number `first` are read, not matched, and not given. The engine must be prepared, take `at_once` pairs, one
  /// of live ones, and outlive this.
  FrameAhead(std::unique_ptr<PairSource> source, Engine& engine, std::int64_t first, int at_once)
      : source_(std::move(source)),
        engine_(engine),
        first_(first),
        count_(source_->count()),
        ring_(static_cast<std::size_t>(at_once)) {
    if (!source_->live()) pairs_.emplace([this](Pair& into) { return source_->next(into); });
    frames_.emplace([this](Matched& into) { return match(into); });
  }
  ~FrameAhead() {
    frames_.reset();
    for (; in_engine_ > 0; --in_engine_) engine_.collect();  // it works on pairs of ours
  }
  FrameAhead(const FrameAhead&) = delete;
  FrameAhead& operator=(const FrameAhead&) = delete;

  std::int64_t count() const { return count_; }
  bool live() const { return source_->live(); }
  /// As PairSource::next(), into last(), and kNothing for each live pair that is not given; not to be called again after the
  /// end or an error.
  Result<Next> next() { return frames_->next(last_); }
  /// Lives until next() gives another.
  const Matched& last() const { return last_; }
  /// Before the end: until the next frame is ready; with one at once, matching then rests.
  void wait() { frames_->wait(); }
  /// Before the end, and with one at once: another setup for the engine. The last frame and the one that is ready are made
  /// anew.
  ///
  /// Errors  those of Engine::prepare(); then all is as it was
  Result<void> prepare(const Setup& setup) {
    Result<void> prepared;
    frames_->amend([&](Matched* ahead) {
      prepared = engine_.prepare(setup);
      if (!prepared) return;
      if (last_.frame != nullptr) make_anew(last_);
      if (ahead != nullptr) make_anew(*ahead);
    });
    return prepared;
  }

  TimeNs start_ns() const { return start_ns_; }  // of the first pair, once next() gave one
  /// Pairs that were read before the end, and what PairSource::warning() says then; live, at any time.
  std::int64_t read() const { return read_; }
  std::string warning() const { return source_->warning(); }
  std::int64_t dropped() const { return source_->dropped(); }
  bool still() const { return source_->still(); }

 private:
  /// A pair that the engine works on.
  struct InEngine {
    Matched matched;
    double since_ms = 0;
  };

  Result<Next> match(Matched& into) {
    while (in_engine_ < ring_.size() && !end_) {
      InEngine& next = ring_[(oldest_ + in_engine_) % ring_.size()];
      Result<Next> read = read_pair(next.matched.pair);
      if (read && *read == Next::kNothing && in_engine_ == 0) return read;
      if (read && *read == Next::kNothing) break;
      if (read && *read == Next::kPicture) {
        submit(next);
        ++in_engine_;
      } else {
        end_ = std::move(read);
      }
    }
    if (in_engine_ == 0) return *end_;
    InEngine& done = ring_[oldest_];
    oldest_ = (oldest_ + 1) % ring_.size();  // first: what cannot be collected is not collected again
    --in_engine_;
    collect(done);
    std::swap(into, done.matched);
    return Next::kPicture;
  }
  Result<Next> read_pair(Pair& into) {
    do {
      DUO_TRY_ASSIGN(const Next next, pairs_ ? pairs_->next(into) : source_->next(into));
      if (next != Next::kPicture) return next;
      if (read_ == 0) start_ns_ = into.left.t_ns;
      if (read_ + 1 == first_) in_step_.right_of(into);                       // from which the first one is told to have moved
      if (read_ < first_ && source_->live()) return ++read_, Next::kNothing;  // it may be long: who waits may want to stop
    } while (read_++ < first_);
    return Next::kPicture;
  }

  void submit(InEngine& of) {
    of.since_ms = clock_ms(CLOCK_MONOTONIC);
    Matched& matched = of.matched;
    Image<Rgb8>* moved = in_step_.right_of(matched.pair);
    matched.in_step = moved != nullptr;
    if (matched.in_step) {
      if (matched.other_right.size() != moved->size()) matched.other_right = Image<Rgb8>(moved->size());
      std::swap(matched.other_right, *moved);
    }
    to_engine(of);
  }
  void to_engine(InEngine& of) {
    if (of.matched.in_step) std::swap(of.matched.pair.right.pixels, of.matched.other_right);
    engine_.submit(of.matched.pair);
  }
  void collect(InEngine& of) {
    of.matched.frame = &engine_.collect();
    of.matched.engine_ms = clock_ms(CLOCK_MONOTONIC) - of.since_ms;
    of.matched.event = engine_.take_event();
    if (of.matched.in_step) std::swap(of.matched.pair.right.pixels, of.matched.other_right);
  }
  void make_anew(Matched& of) {
    std::swap(of, ring_[oldest_].matched);
    ring_[oldest_].since_ms = clock_ms(CLOCK_MONOTONIC);
    to_engine(ring_[oldest_]);  // in step as it was: the cameras have moved on since
    collect(ring_[oldest_]);
    std::swap(of, ring_[oldest_].matched);
  }

  std::unique_ptr<PairSource> source_;
  Engine& engine_;
  const std::int64_t first_, count_;
  std::int64_t read_ = 0;
  TimeNs start_ns_ = 0;
  InStep in_step_;
  std::vector<InEngine> ring_;
  std::size_t oldest_ = 0, in_engine_ = 0;  // in_engine_ of ring_ from oldest_
  std::optional<Result<Next>> end_;         // what came after them
  Matched last_;
  std::optional<Ahead<Pair>> pairs_;  // the threads come last, in the order of who uses whom
  std::optional<Ahead<Matched>> frames_;
};

}  // namespace duo::app
