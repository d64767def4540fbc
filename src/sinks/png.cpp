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

Result<Image<std::uint16_t>> read_png16(const std::filesystem::path& path) {
  constexpr std::size_t kMaxBytes = std::size_t{1} << 28;
  DUO_TRY_ASSIGN(const std::string bytes, read_file(path, kMaxBytes, "PNG picture"));
  const auto refused = [&](const char* why) {
    return Error{ErrorCode::kBadInput, fmt::format("cannot read PNG picture '{}': {}", path.string(), why)};
  };
  cv::Mat read;
  try {
    const cv::Mat coded(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char*>(bytes.data()));
    if (!coded.empty()) read = cv::imdecode(coded, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    // The same as when it returns nothing.
  }
  if (read.empty()) return refused("it is no picture, or cut short");
  if (read.channels() != 1) return refused("it is coloured; give a gray one");
  Image<std::uint16_t> out({read.cols, read.rows});
  cv::Mat into(read.rows, read.cols, CV_16UC1, out.row(0), static_cast<std::size_t>(out.stride()) * sizeof(std::uint16_t));
  read.convertTo(into, CV_16U);
  return out;
}

}  // namespace duo
