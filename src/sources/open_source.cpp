// open_source(): which kind of file it is, and every way in which it cannot be read at all.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <limits>
#include <string>
#include <system_error>

#include "core/file.h"
#include "duoptic/source.h"
#include "sources/camera/camera.h"
#include "sources/camera/modes.h"
#include "sources/libav.h"
#include "sources/pictures.h"
#include "sources/stream.h"
#include "sources/video.h"

namespace duo {

Result<std::unique_ptr<Source>> open_source(const std::filesystem::path& path, const CameraWish& wish) {
  const std::string name = path.string();
  if (is_camera_name(name)) return open_camera(linux_calls(), name, wish);
  if (is_stream_name(name)) return open_stream(name);
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status))
    return Error{ErrorCode::kNotFound,
                 fmt::format("cannot read {}: {}", name.empty() ? "''" : name,
                             error && error != std::errc::no_such_file_or_directory ? error.message() : "no such file")};
  if (!std::filesystem::is_regular_file(status))
    return Error{ErrorCode::kBadInput, fmt::format("cannot read {}: it is not a file; give a picture or a video", name)};
  // Of any size: of a video only parts are ever in memory.
  DUO_TRY_ASSIGN(const Descriptor file, open_file(path, std::numeric_limits<std::size_t>::max(), "input"));
  std::string head(kPictureMagicBytes, '\0');
  const ssize_t read = ::pread(file.get(), head.data(), head.size(), 0);
  if (read < 0) return Error{ErrorCode::kBadInput, fmt::format("cannot read {}: {}", name, std::strerror(errno))};
  head.resize(static_cast<std::size_t>(read));
  if (head.empty()) return Error{ErrorCode::kBadInput, fmt::format("cannot read {}: the file is empty", name)};
  av_log_set_level(AV_LOG_QUIET);  // what is wrong is said in our results
  return is_picture(head) ? open_picture(path) : open_video(path);
}

}  // namespace duo
