// `duoptic eval clip`, and what it shares with `demo`.
#pragma once

#include <filesystem>
#include <vector>

#include "duoptic/evaluation.h"
#include "tracking_options.h"

namespace duo::app::eval_clip {

/// Adds `duoptic eval clip`.
Command add(CLI::App& eval);

/// What score_clip() runs, with all maps.
///
/// Errors  those of TrackingOptions::setup()
Result<PipelineSetup> setup_of(const TrackingOptions& tracking, const std::filesystem::path& clip, const Rig& rig);

}  // namespace duo::app::eval_clip
