// A rig from two files' texts.
#include <fmt/format.h>

#include <optional>
#include <utility>
#include <vector>

#include "calib/rig_formats.h"
#include "calib/yaml_reader.h"
#include "duoptic/rig_files.h"

namespace duo {
namespace {

/// The first document of a file when it is one camera's camera_info.
Result<std::optional<YAML::Node>> ros_camera_of(std::string_view text, const std::string& name) {
  if (text.front() == '{' || text.front() == '<') return std::optional<YAML::Node>();
  DUO_TRY_ASSIGN(const std::vector<YAML::Node> documents, yaml_documents(text, name));
  return is_ros_camera(documents.front()) ? std::optional(documents.front()) : std::nullopt;
}

}  // namespace

Result<RigImport> rig_from_two_texts(std::string_view first, std::string_view second, const std::string& first_name,
                                     const std::string& second_name, Size size) {
  DUO_TRY_ASSIGN(first, rig_text(first, first_name));
  DUO_TRY_ASSIGN(second, rig_text(second, second_name));
  DUO_TRY_ASSIGN(const auto left, ros_camera_of(first, first_name));
  DUO_TRY_ASSIGN(const auto right, ros_camera_of(second, second_name));
  RigImport read;
  if (left && right) {
    DUO_TRY_ASSIGN(read.rig, rig_from_ros(*left, *right, first_name));
    return read;
  }
  if (left || right) return rig_error(left ? second_name : first_name, "two files are a pair of ROS camera_info; this is none");
  DUO_TRY_ASSIGN(OpencvNumbers numbers, opencv_numbers(first, first_name));
  DUO_TRY_ASSIGN(OpencvNumbers more, opencv_numbers(second, second_name));
  if (numbers.empty() || more.empty())
    return rig_error(numbers.empty() ? first_name : second_name,
                     "two files are a pair of ROS camera_info, or OpenCV's intrinsics and extrinsics; this is neither");
  numbers.merge(more);
  if (const std::vector<Size> likely = likely_sizes(numbers);
      size.width == 0 && !numbers.contains("image_width") && !numbers.contains("image_size") && likely.size() == 1) {
    size = likely.front();
    read.note = fmt::format(
        "the files do not say how large the pictures are; {}x{} is taken, in whose middle both principal "
        "points lie; --size WxH says otherwise",
        size.width, size.height);
  }
  DUO_TRY_ASSIGN(read.rig, rig_from_opencv(numbers, first_name, size));
  return read;
}

}  // namespace duo
