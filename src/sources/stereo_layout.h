// Where both views lie in a picture, as a video says it.
#pragma once

#include <optional>
#include <string>

#include "duoptic/source.h"

extern "C" {
#include <libavformat/avformat.h>
}

namespace duo {

/// Where both views are, as container or codec say it; empty where they say nothing, or that there is one.
///
/// `name`   set to what is not read: views in turn, interleaved or as a checkerboard
std::optional<ViewLayout> layout_of(const AVStream& stream, const AVFrame& frame, std::string& name);

}  // namespace duo
