// What a task's results say, in a few numbers.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace duo {

/// Of the results of track: frames, people per frame and each joint's counts of seen, inferred and lost. Of depth: frames,
/// coverage and the rig's fit. Null where they cannot be read.
///
/// `said`  what depth said with --json
nlohmann::json summarize_tracks(const std::filesystem::path& lines);
nlohmann::json summarize_depth(const std::filesystem::path& said);

}  // namespace duo
