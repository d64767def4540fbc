// What lies before the first wanted pair of files.
#pragma once

#include <string>

#include "pipeline/frame_stream.h"
#include "pipeline/rig_watch.h"
#include "sources/file_source.h"

namespace duo {

/// Passes over pairs. The rig is judged by the first second and frames are aligned by the pair before, as in a run of all
/// frames; what lies between is not read where the files have indices.
///
/// `news`  what `watch` had to tell
/// Errors  those of FilePairs
Result<FrameStream::Passed> pass_over(FilePairs& files, const FrameStream::Choice& choice, RigWatch& watch, std::string& news);

}  // namespace duo
