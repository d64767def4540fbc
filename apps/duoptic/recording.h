// A recording of pairs on their way to whoever else takes them.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "duoptic/recording.h"
#include "duoptic/source.h"

namespace duo::app {

/// Of the recording that runs, or ran last.
struct RecordingStatus {
  bool on = false;
  std::string name = {};  // empty: there was none
  std::int64_t pairs = 0, bytes = 0;
  double length_s = 0;       // from the first pair's capture to the last one's
  std::string problem = {};  // empty: none
};

/// "duoptic_2026-05-31_14-03-59.mkv" in the working folder, by the user's time; a name that no file has.
std::string dated_recording_name();

/// One file after the other.
///
/// Threads  any
class Recording {
 public:
  /// Does nothing while one runs.
  ///
  /// Errors  those of Recorder::open(); they are in status(), too
  Result<void> start(const std::string& name, const RecorderSetup& setup);
  /// Completes the file.
  void stop();
  /// Writes the pair when a recording runs.
  void take(const Pair& pair);

  RecordingStatus status() const;
  /// The first thing that went wrong.
  std::optional<Error> failure() const;

 private:
  void fail(const Error& error);

  std::mutex file_mutex_;  // a slow disk keeps nobody from status()
  std::optional<Recorder> file_;
  TimeNs start_ns_ = 0;

  mutable std::mutex mutex_;  // of what follows
  RecordingStatus status_;
  std::optional<Error> failure_;
};

/// Gives a source's pairs, each of which a recording sees first. A live source is read in a thread of its own: all its pairs
/// are recorded, also those that nobody takes in time, and while whoever takes them pauses.
class Tap final : public PairSource {
 public:
  Tap(std::unique_ptr<PairSource> source, Recording& recording);
  ~Tap() override;

  Size size() const override { return source_->size(); }
  std::int64_t count() const override { return source_->count(); }
  bool still() const override { return source_->still(); }
  double frame_s() const override { return source_->frame_s(); }
  std::optional<Rig> rig() const override { return source_->rig(); }
  bool live() const override { return source_->live(); }
  std::int64_t dropped() const override { return source_->dropped() + dropped_; }
  std::string warning() const override { return source_->warning(); }
  Result<Next> next(Pair& into) override;

 private:
  Result<Next> read(Pair& into);
  void read_all();

  std::unique_ptr<PairSource> source_;
  Recording& recording_;
  std::mutex mutex_;
  std::condition_variable changed_;
  Pair newest_;
  std::optional<Result<Next>> arrived_;  // what became of newest_; empty: it was taken
  std::atomic<std::int64_t> dropped_ = 0;
  std::atomic<bool> stopped_ = false;
  std::thread reader_;  // last: it uses all of the above
};

}  // namespace duo::app
