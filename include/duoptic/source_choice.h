// What somebody wants to look at: chosen from files that are given together, or again.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "duoptic/result.h"

namespace [[gnu::visibility("default")]] duo {

/// As open_pairs() and load_rig() take it; an empty name: none.
struct SourceChoice {
  std::string left, right, rig;
  friend bool operator==(const SourceChoice&, const SourceChoice&) = default;
};

/// What files mean that are given together in any order: a rig (.json, .yml, .yaml or .xml) and one or two pictures or videos.
/// Of two, the left one has "left" in its name or the other has "right"; else it is the first by alphabet.
///
/// Errors  two rigs; three pictures or videos
Result<SourceChoice> choose_files(std::vector<std::filesystem::path> files);

/// What remember_source() was told, newest first, kMostRecent at most; without those whose files are gone.
inline constexpr std::size_t kMostRecent = 8;
std::vector<SourceChoice> recent_sources();
/// Kept in the user's cache, by absolute paths. A failure to write is ignored.
void remember_source(SourceChoice choice);

}  // namespace duo
