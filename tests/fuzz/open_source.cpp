// Of what the library opens, videos: its own open_source() looks for cameras and streams first.
#include "duoptic/source.h"
#include "sources/video.h"

namespace duo {

Result<std::unique_ptr<Source>> open_source(const std::filesystem::path& path, const CameraWish&) { return open_video(path); }

}  // namespace duo
