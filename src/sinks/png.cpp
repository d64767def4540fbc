#include <fmt/format.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/file.h"
#include "duoptic/sink.h"

namespace duo {
namespace {

template <class T>
cv::Mat mat_of(View<const T> picture, int type) {
  return {picture.height(), picture.width(), type, const_cast<T*>(picture.data()),
          static_cast<std::size_t>(picture.stride()) * sizeof(T)};
}

Result<void> write(const cv::Mat& picture, const std::filesystem::path& path) {
  std::vector<std::uint8_t> bytes;
  try {
    if (cv::imencode(".png", picture, bytes))
      return write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  } catch (const cv::Exception&) {
    // The same as when it returns false.
  }
  return Error{ErrorCode::kWriteFailed,
               fmt::format("cannot write '{}': {}x{} pixels cannot be encoded as PNG; give a picture of at least one pixel",
                           path.string(), picture.cols, picture.rows)};
}

}  // namespace

Result<void> write_png(View<const Rgb8> picture, const std::filesystem::path& path) {
  cv::Mat bgr;
  if (!picture.empty()) cv::cvtColor(mat_of(picture, CV_8UC3), bgr, cv::COLOR_RGB2BGR);
  return write(bgr, path);
}

Result<void> write_png(View<const std::uint8_t> picture, const std::filesystem::path& path) {
  return write(mat_of(picture, CV_8UC1), path);
}

Result<void> write_png(View<const std::uint16_t> picture, const std::filesystem::path& path) {
  return write(mat_of(picture, CV_16UC1), path);
}

}  // namespace duo
