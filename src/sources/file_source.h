// What pairing asks of a file, beyond what every source gives.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "duoptic/source.h"
#include "sources/wide_values.h"

namespace duo {

/// A picture or a video.
class FileSource : public Source {
 public:
  /// How its pictures hold both views, where the file says so.
  virtual std::optional<ViewLayout> layout() const { return std::nullopt; }
  /// Views that the file holds apart: video tracks of one size, pictures of an MPO. See open_view().
  virtual int views() const { return 1; }
  /// Values of more than eight bits are scaled as those of `other` from now on, and the other way round.
  virtual void scale_as(FileSource& other) = 0;

  // Of a video:

  /// When its pictures begin and end, in its own times; the end is 0 where it is not known.
  virtual TimeNs first_ns() const { return 0; }
  virtual TimeNs end_ns() const { return 0; }
  /// True where times count from a moment of the container's own choice, not from when recording began.
  virtual bool any_origin() const { return false; }
  /// Adds this to all times of pictures to come.
  virtual void shift_times(TimeNs) {}
  /// Number in the file of the last picture given, from 0; damaged ones count.
  virtual std::int64_t number() const { return 0; }
  /// The time of each picture, by number, as next() gives it and the file's index tells it; empty where pictures need others
  /// to be decoded, where the index does not name each, and where times are not in it.
  virtual std::vector<TimeNs> indexed_times() { return {}; }
  /// Whether seek() finds every picture of a recording of ours. Then seek() has to follow.
  virtual bool prepare_seek() { return false; }
  /// The next picture is number `number`, or the first whole one after it. After indexed_times() or prepare_seek() said so.
  ///
  /// Errors  the index is wrong; those of next()
  virtual Result<void> seek(std::int64_t) { return Error{ErrorCode::kUnsupported, "cannot seek in a file without an index"}; }
};

/// Pairs of files. After the end next() gives the end again.
class FilePairs : public PairSource {
 public:
  /// The next pair is number `number`, which lies ahead, or the end comes before it. Where the files have indices the pairs
  /// between are not read, so that a damaged picture among them counts, which in a run of all pairs does not.
  ///
  /// Returns  the number of the next pair
  /// Errors   those of next(); an index that is wrong
  virtual Result<std::uint64_t> pass_to(std::uint64_t number) = 0;

 protected:
  /// Without an index.
  Result<std::uint64_t> read_to(std::uint64_t number, std::uint64_t given) {
    Pair passed;
    for (; given < number; ++given) {
      DUO_TRY_ASSIGN(const Next next, this->next(passed));
      if (next != Next::kNew) break;
    }
    return given;
  }
};

/// View `view` of a file that has several, from 0.
///
/// Errors  those of open_source()
Result<std::unique_ptr<Source>> open_view(const std::filesystem::path& path, int view);

}  // namespace duo
