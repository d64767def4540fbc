// A recording of pairs on their way to whoever else takes them.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>

#include "duoptic/bounded_queue.h"
#include "duoptic/pipeline.h"
#include "duoptic/source.h"
#include "duoptic/worker.h"

namespace duo {

/// One file after the other.
///
/// Threads  any
class Recording {
 public:
  /// Does nothing while a file is written.
  ///
  /// Errors  those of Recorder::open(); they are in status(), too
  Result<void> start(const std::filesystem::path& path, const RecorderSetup& setup, double most_s);
  /// Completes the file.
  void stop();
  /// Writes the pair while a file is open. `dropped`: of the pair's source, so far.
  void take(const Pair& pair, std::int64_t dropped);

  RecordingStatus status() const;
  /// The first that any of the files had.
  std::optional<Error> first_failure() const;

 private:
  void complete();
  void fail(const Error& error);

  std::mutex file_mutex_;  // a slow disk keeps nobody from status()
  std::optional<Recorder> file_;
  double most_s_ = 0;
  TimeNs start_ns_ = 0;
  std::int64_t dropped_before_ = 0;

  mutable std::mutex mutex_;  // of what follows
  RecordingStatus status_;
  std::optional<Error> first_failure_;
};

/// Gives a source's pairs, each of which `recording` sees first.
///
/// Threads  one caller of next(), one of read_all_pairs(), any for dropped() and warning()
class Tap final : public PairSource {
 public:
  Tap(std::unique_ptr<PairSource> source, std::shared_ptr<Recording> recording);

  /// From now on a thread of its own reads a live source: all its pairs are recorded, also those that nobody takes in time, and
  /// while whoever takes them pauses. Until then, and of files, next() reads: a frame does without that thread.
  ///
  /// Errors  the system gives no thread
  Result<void> read_all_pairs();

  Size size() const override { return source_->size(); }
  std::int64_t count() const override { return source_->count(); }
  bool still() const override { return source_->still(); }
  double frame_s() const override { return source_->frame_s(); }
  std::optional<Rig> rig() const override { return source_->rig(); }
  bool live() const override { return source_->live(); }
  std::int64_t dropped() const override { return source_->dropped() + pairs_.dropped(); }
  std::string warning() const override { return source_->warning(); }
  Result<Next> next(Pair& into) override;

 private:
  Result<Next> read(Pair& into);
  Result<void> read_all(const std::stop_token& stop);

  std::unique_ptr<PairSource> source_;
  std::shared_ptr<Recording> recording_;
  std::mutex source_mutex_;  // of source_->next()
  std::atomic<bool> reads_ = false;
  BoundedQueue<Pair> pairs_{1, WhenFull::kDropOldest};
  std::atomic<Next> end_ = Next::kEnd;
  Worker reader_;  // last: it uses all of the above
};

}  // namespace duo
