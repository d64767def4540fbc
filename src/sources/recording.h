// The head of a recording: all that it says before its first picture.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/capture_mark.h"
#include "duoptic/frame.h"
#include "duoptic/result.h"
#include "duoptic/rig.h"
#include "sources/libav.h"

namespace duo {

/// A Matroska file and its two video tracks, opened without a look at its pictures.
struct TwoTracks {
  av::Container container;             // empty where there is no such file
  std::vector<const AVStream*> views;  // left, right

  std::string tag(const char* name) const;
  TimeNs frame_ns() const { return CaptureMark::frame_ns(*container); }
  bool ours() const { return frame_ns() > 0; }
  /// A file of ours has a length once it is finished.
  bool finished() const { return container->duration > 0; }
  /// Errors  one that cannot be
  Result<std::optional<Rig>> rig(const std::string& name) const;
};
/// Errors  the machine lacks memory or files
Result<TwoTracks> open_two_tracks(const std::filesystem::path& path);

struct RecordingHead {
  bool ours = false;       // its tracks were paired when it was made; else they pair by time
  std::int64_t pairs = 0;  // by its index; 0: it has none, because it was killed or cut
  std::optional<Rig> rig = {};
};

/// Empty for a file that is no Matroska file with two video tracks.
///
/// Errors  an attached rig that cannot be one
Result<std::optional<RecordingHead>> read_recording_head(const std::filesystem::path& path);

}  // namespace duo
