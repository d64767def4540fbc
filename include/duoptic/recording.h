// A recording: the pairs of two cameras in one Matroska file, each picture as it was delivered, with capture times and the rig.
// open_pairs() reads it; docs/formats.md has every field.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "duoptic/frame.h"
#include "duoptic/result.h"
#include "duoptic/rig.h"

namespace [[gnu::visibility("default")]] duo {

struct RecorderSetup {
  double frame_s = 1.0 / 30;
  std::optional<Rig> rig = {};
  std::string date = {};  // when it was taken, ISO 8601 in UTC; empty: not said, and the same pairs give the same bytes
  bool replace = false;   // an earlier file of that name
};

/// Writes pairs as they come, under the final name from the first one on: what was recorded cannot be recorded again, so that a
/// program that is killed must leave all up to the last pair, where its user looks for it. For the same reason a file that is
/// there already stays unless `replace` is set.
///
/// Threads  one caller
class Recorder {
 public:
  /// Errors  the name is taken, no such folder, no permission
  static Result<Recorder> open(const std::filesystem::path& path, const RecorderSetup& setup);
  Recorder(Recorder&&) noexcept;
  Recorder& operator=(Recorder&&) noexcept;
  ~Recorder();  // finishes the file

  /// Appends a pair: a Picture::jpeg as it is, other pictures as FFV1, without loss. All of it is with the system at return.
  ///
  /// Errors   a full disk or quota: the file holds the pairs before this one, and is finished; pictures that are not of the
  ///          first pair's size, or no longer JPEG while the first was
  Result<void> write(const Pair& pair);
  /// Writes index and length, and flushes the file to the disk; without a pair no file is left.
  Result<void> finish();

  std::int64_t pairs() const;
  std::int64_t bytes() const;  // of the file, so far
  std::string codecs() const;  // of left and right, like "MJPEG, MJPEG"

 private:
  struct State;
  explicit Recorder(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// What one camera's track of a recording holds.
struct RecordedView {
  std::string codec;
  std::int64_t pictures = 0;
  std::int64_t missing = 0;  // numbers between the first and the last picture's that no picture has: taken, not recorded
};

struct RecordingReport {
  RecordedView left, right;
  Size size;
  std::int64_t pairs = 0, bytes = 0;
  double length_s = 0;       // from the first pair's capture to the last one's
  double longest_gap_s = 0;  // between one left picture and the next
  double skew_s = 0;         // largest difference of capture times in a pair
  std::optional<Rig> rig;
  std::string date;  // empty: not said
  bool cut = false;  // killed or cut short; whole pairs up to there are good
};

/// Reads through the whole file without decoding its pictures.
///
/// Errors  missing; no file with two video tracks; a rig in it that cannot be one
Result<RecordingReport> inspect_recording(const std::filesystem::path& path);

struct RecordingFiles {
  std::filesystem::path left_avi, right_avi, times_csv;
};
/// Writes both tracks' packets as they are into AVIs of their own, as far as there are whole pairs, and their capture times,
/// which an AVI cannot hold: pair,left_t_s,right_t_s,left_number,right_number. The files are not published by themselves:
/// meant for a folder that is.
///
/// Errors  those of inspect_recording(); a file cannot be written
Result<void> export_recording(const std::filesystem::path& path, const RecordingFiles& to);

}  // namespace duo
