// A video file as a source.
#pragma once

#include <memory>
#include <optional>

#include "duoptic/source.h"

namespace duo {

/// Opens a video stream of AVI, Matroska/WebM, MP4/MOV, MPEG-TS/PS or of JPEGs one after the other: the one that players
/// choose, or number `track` of its video streams. `format`: libav's name of the container, where its beginning does not tell.
///
/// A file that lacks bytes at its end gives its whole pictures and then Next::kCut. A picture that is damaged, or coded by one
/// that is, is left out and counted (Source::warning()); a partly decoded one is never given.
///
/// Errors  not a video; no picture can be decoded from its start; views that are neither halves nor tracks
Result<std::unique_ptr<Source>> open_video(const std::filesystem::path& path, std::optional<int> track = {},
                                           const char* format = nullptr);

}  // namespace duo
