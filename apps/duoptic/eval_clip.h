// A clip with exact joints through engine and tracker, scored: what `eval clip` and `demo` share.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "clip_score.h"
#include "tracking_options.h"

namespace duo::app::eval_clip {

/// Adds `duoptic eval clip`.
Command add(CLI::App& eval);

struct ClipScore {
  std::string clip, tracker;
  std::int64_t first = 0, frames = 0;
  double fps = 0;
  std::vector<std::pair<JointId, JointScore>> joints;
  std::optional<DepthScore> depth;
  std::string note;  // what there is to say about the video
};

/// With `rig` (the true one of the clip, or one found for its cameras) tracks from the first frame that shows what has to be
/// clicked, each click moved by `jitter_px`, and scores `joints`; none: those of the arm that moves, or all of a tracker that
/// starts by itself. Draws the panels into `video` when it is given (its time is not counted).
Result<ClipScore> track_clip(const std::filesystem::path& folder, const ClipTruth& truth, const Rig& rig,
                             const TrackingOptions& options, const std::vector<JointId>& joints, double jitter_px,
                             const std::string& video = {});

/// The table of scores, with its heading.
void print(const std::vector<ClipScore>& scores);

}  // namespace duo::app::eval_clip
