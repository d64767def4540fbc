// A video file as a source.
#pragma once

#include <memory>
#include <optional>

#include "duoptic/source.h"

namespace duo {

/// Opens a video stream of AVI, Matroska/WebM, MP4/MOV or MPEG-TS/PS: the one that players choose, or number `track` of its
/// video streams.
///
/// A file cut short, or damaged, gives its pictures up to there and then Next::kCut: seen by a packet that is not whole, a
/// picture that does not decode, or fewer pictures than the container announces. A partly decoded picture is never given.
///
/// Errors  not a video; no picture can be decoded from its start
Result<std::unique_ptr<Source>> open_video(const std::filesystem::path& path, std::optional<int> track = {});

}  // namespace duo
