// A recording of pairs on their way to whoever else takes them.
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "duoptic/pipeline.h"
#include "duoptic/source.h"

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

/// Gives a source's pairs, each of which `recording` sees first. A live source is read by a thread of its own: all its pairs
/// are recorded, also those that nobody takes in time, and while whoever takes them pauses.
///
/// Errors  the system gives no thread
Result<std::unique_ptr<PairSource>> tapped(std::unique_ptr<PairSource> pairs, std::shared_ptr<Recording> recording);

}  // namespace duo
