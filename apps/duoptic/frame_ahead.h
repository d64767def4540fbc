// Reads the pairs of a clip and makes frames of them ahead of who takes them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "ahead.h"
#include "duoptic/engine.h"
#include "duoptic/in_step.h"
#include "timing.h"

namespace duo::app {

/// A pair and the frame that an engine made of it.
struct Matched {
  Pair pair;
  const Frame* frame = nullptr;
  double engine_ms = 0;
  std::string event;  // Engine::take_event()
};

/// Pairs through an engine, one frame ahead; files are read one pair ahead of that. A live source gives its newest pair when
/// the engine is free.
class FrameAhead {
 public:
  /// Pairs before number `first` are read, not matched, and not given. The engine must be prepared, and outlive this.
  FrameAhead(std::unique_ptr<PairSource> source, Engine& engine, std::int64_t first)
      : source_(std::move(source)), engine_(engine), first_(first), count_(source_->count()) {
    if (!source_->live()) pairs_.emplace([this](Pair& into) { return source_->next(into); });
    frames_.emplace([this](Matched& into) { return match(into); });
  }

  std::int64_t count() const { return count_; }
  bool live() const { return source_->live(); }
  /// As PairSource::next(), into last(), and kNothing for each live pair that is not given; not to be called again after the
  /// end or an error.
  Result<Next> next() { return frames_->next(last_); }
  /// Lives until next() gives another.
  const Matched& last() const { return last_; }
  /// Before the end: until the next frame is ready; matching then rests.
  void wait() { frames_->wait(); }
  /// Before the end: another setup for the engine. The last frame and the one that is ready are made anew.
  ///
  /// Errors  those of Engine::prepare(); then all is as it was
  Result<void> prepare(const Setup& setup) {
    Result<void> prepared;
    frames_->amend([&](Matched* ahead) {
      prepared = engine_.prepare(setup);
      if (!prepared) return;
      if (last_.frame != nullptr) make_frame(last_);
      if (ahead != nullptr) make_frame(*ahead);
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
  Result<Next> match(Matched& into) {
    do {
      DUO_TRY_ASSIGN(const Next next, pairs_ ? pairs_->next(into.pair) : source_->next(into.pair));
      if (next != Next::kPicture) return next;
      if (read_ == 0) start_ns_ = into.pair.left.t_ns;
      if (read_ < first_ && source_->live()) return ++read_, Next::kNothing;  // it may be long: who waits may want to stop
    } while (read_++ < first_);
    make_frame(into);
    return Next::kPicture;
  }
  void make_frame(Matched& of) {
    of.engine_ms = timed([&] {
                     Image<Rgb8>* moved = in_step_.right_of(of.pair);
                     if (moved != nullptr) std::swap(of.pair.right.pixels, *moved);  // for the engine only
                     engine_.submit(of.pair);
                     of.frame = &engine_.collect();
                     if (moved != nullptr) std::swap(of.pair.right.pixels, *moved);
                   }).wall_ms;
    of.event = engine_.take_event();
  }

  std::unique_ptr<PairSource> source_;
  Engine& engine_;
  const std::int64_t first_, count_;
  std::int64_t read_ = 0;
  TimeNs start_ns_ = 0;
  InStep in_step_;
  Matched last_;
  std::optional<Ahead<Pair>> pairs_;  // the threads come last, in the order of who uses whom
  std::optional<Ahead<Matched>> frames_;
};

}  // namespace duo::app
