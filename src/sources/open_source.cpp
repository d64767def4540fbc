// open_source(): which kind of file it is, and every way in which it cannot be read at all.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <string>
#include <system_error>

#include "core/file.h"
#include "duoptic/source.h"
#include "sources/camera/camera.h"
#include "sources/camera/modes.h"
#include "sources/file_source.h"
#include "sources/libav.h"
#include "sources/picture_bytes.h"
#include "sources/pictures.h"
#include "sources/stream.h"
#include "sources/video.h"

namespace duo {

namespace {

/// Up to `most` bytes from the file's beginning.
Result<std::string> beginning(const Descriptor& file, std::size_t most, const std::string& name) {
  std::string bytes(most, '\0');
  std::size_t got = 0;
  for (ssize_t n = 1; n > 0 && got < most; got += static_cast<std::size_t>(n)) {
    n = ::pread(file.get(), bytes.data() + got, most - got, static_cast<off_t>(got));
    if (n < 0) return Error{ErrorCode::kBadInput, fmt::format("cannot read {}: {}", name, std::strerror(errno))};
  }
  bytes.resize(got);
  return bytes;
}

Result<std::unique_ptr<Source>> open_file_source(const std::filesystem::path& path, int view, std::optional<int> track) {
  const std::string name = path.string();
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
  DUO_TRY_ASSIGN(const std::string head, beginning(file, kPictureMagicBytes, name));
  if (head.empty()) return Error{ErrorCode::kBadInput, fmt::format("cannot read {}: the file is empty", name)};
  if (const auto kind = foreign_kind(head))
    return Error{ErrorCode::kUnsupported,
                 fmt::format("cannot read {}: it is {}, and that is not read; {}", name, kind->name, kind->advice)};
  av_log_set_level(AV_LOG_QUIET);  // what is wrong is said in our results
  if (!is_picture(head)) return open_video(path, track);
  if (is_jpeg(head)) {
    constexpr std::uintmax_t kMostOfFirst = std::uintmax_t{64} << 20;
    const std::uintmax_t size = std::min(std::filesystem::file_size(path, error), kMostOfFirst);
    DUO_TRY_ASSIGN(const std::string bytes, beginning(file, static_cast<std::size_t>(size), name));
    if (is_jpeg_sequence(bytes)) return open_video(path, track, "mjpeg");
  }
  return open_picture(path, view);
}

}  // namespace

Result<std::unique_ptr<Source>> open_source(const std::filesystem::path& path, const CameraWish& wish) {
  const std::string name = path.string();
  if (is_camera_name(name)) return open_camera(linux_calls(), name, wish);
  if (is_stream_name(name)) return open_stream(name);
  return open_file_source(path, 0, std::nullopt);
}

Result<std::unique_ptr<Source>> open_view(const std::filesystem::path& path, int view) {
  return open_file_source(path, view, view);
}

}  // namespace duo
