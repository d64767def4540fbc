// What pairing asks of a file, beyond what every source gives.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "duoptic/source.h"
#include "sources/gray_scale.h"

namespace duo {

/// A picture or a video.
class FileSource : public Source {
 public:
  /// How its pictures hold both views, where the file says so.
  virtual std::optional<ViewLayout> layout() const { return std::nullopt; }
  /// Views that the file holds apart: video tracks of one size, pictures of an MPO. See open_view().
  virtual int views() const { return 1; }
  /// Gray of more than eight bits is scaled as that of `other` from now on, and the other way round.
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
};

/// View `view` of a file that has several, from 0.
///
/// Errors  those of open_source()
Result<std::unique_ptr<Source>> open_view(const std::filesystem::path& path, int view);

}  // namespace duo
