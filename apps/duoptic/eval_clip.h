// A clip with exact joints through engine and tracker, scored: what `eval clip` and `demo` share.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "arm_run.h"
#include "clip_score.h"

namespace duo::app::eval_clip {

struct ClipScore {
  std::string clip, tracker_preset;
  std::int64_t first = 0, frames = 0;
  double fps = 0;
  std::array<JointScore, kArmJoints> joints;
  std::optional<DepthScore> depth;
  std::string note;  // what there is to say about the video
};

/// With `rig` (the true one of the clip, or one found for its cameras) tracks the selected arm from the first frame that shows
/// all of it, each click moved by `jitter_px`; draws the panels into `video` when it is given (its time is not counted).
Result<ClipScore> track_clip(const std::filesystem::path& folder, const ClipTruth& truth, const Rig& rig,
                             const ArmOptions& options, double jitter_px, const std::string& video = {});

/// The table of scores, with its heading.
void print(const std::vector<ClipScore>& scores);

}  // namespace duo::app::eval_clip
