// OpenCV's calibration files. Both syntaxes are first reduced to named lists of numbers; one reader serves them all.
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "calib/rig_formats.h"
#include "calib/yaml_reader.h"

namespace duo {
namespace {

using Numbers = std::map<std::string, std::vector<double>, std::less<>>;

struct Spelling {
  const char *left_matrix, *left_distortion, *right_matrix, *right_distortion;
};
constexpr Spelling kSpellings[] = {
    {"cameraMatrix1", "distCoeffs1", "cameraMatrix2", "distCoeffs2"},
    {"M1", "D1", "M2", "D2"},
    {"camera_matrix_left", "dist_coeffs_left", "camera_matrix_right", "dist_coeffs_right"},
};

bool is_known(std::string_view key) {
  if (key == "image_width" || key == "image_height" || key == "image_size" || key == "R" || key == "T") return true;
  return std::any_of(std::begin(kSpellings), std::end(kSpellings), [&](const Spelling& s) {
    return key == s.left_matrix || key == s.left_distortion || key == s.right_matrix || key == s.right_distortion;
  });
}

// A list holds numbers, or rows of numbers as people write them by hand.
bool append_numbers(const nlohmann::json& node, int depth, std::vector<double>& out) {
  if (node.is_number()) {
    out.push_back(node.get<double>());
    return out.size() <= kMaxNumbers;
  }
  if (depth == 2 || !node.is_array() || node.size() > kMaxNumbers) return false;
  return std::all_of(node.begin(), node.end(), [&](const auto& item) { return append_numbers(item, depth + 1, out); });
}

Error not_numbers(const std::string& key, const std::string& name) {
  return rig_error(name, "key '{}' is not a matrix of at most {} numbers", key, kMaxNumbers);
}

Result<Numbers> numbers_from_yaml(const YAML::Node& map, const std::string& name) {
  Numbers numbers;
  for (const auto& entry : map) {
    if (!entry.first.IsScalar() || !is_known(entry.first.Scalar())) continue;
    const std::string& key = entry.first.Scalar();
    if (!read_numbers(entry.second, numbers[key])) return not_numbers(key, name);
  }
  return numbers;
}

Result<Numbers> numbers_from_json(const nlohmann::json& json, const std::string& name) {
  Numbers numbers;
  for (const auto& [key, value] : json.items()) {
    if (!is_known(key)) continue;
    const bool matrix = value.is_object();
    if ((matrix && !value.contains("data")) || !append_numbers(matrix ? value["data"] : value, 0, numbers[key]))
      return not_numbers(key, name);
  }
  return numbers;
}

/// Finds named lists of the right length and keeps the first thing that is wrong.
class OpencvReader {
 public:
  explicit OpencvReader(const Numbers& numbers) : numbers_(numbers) {}
  const std::string& wrong() const { return wrong_; }

  /// Empty when the key is missing or has another count than the allowed ones.
  std::vector<double> take(const char* key, std::initializer_list<std::size_t> counts, const char* advice) {
    const auto found = numbers_.find(key);
    if (found == numbers_.end()) {
      complain(fmt::format("key '{}' is missing; {}", key, advice));
    } else if (std::find(counts.begin(), counts.end(), found->second.size()) == counts.end()) {
      complain(fmt::format("key '{}' has {} numbers; {}", key, found->second.size(), advice));
    } else {
      return found->second;
    }
    return {};
  }
  void complain(std::string what) {
    if (wrong_.empty()) wrong_ = std::move(what);
  }

 private:
  const Numbers& numbers_;
  std::string wrong_;
};

int whole(OpencvReader& reader, const char* key, double value) {
  if (!(value == std::floor(value)) || std::abs(value) > 1e6)
    reader.complain(fmt::format("key '{}' is {}, not a size in pixels", key, value));
  return reader.wrong().empty() ? static_cast<int>(value) : 0;
}

Size read_size(OpencvReader& reader, const Numbers& numbers) {
  constexpr const char* kAdvice = "give the size of the calibrated pictures (image_width and image_height, or image_size)";
  if (numbers.contains("image_size")) {
    const auto size = reader.take("image_size", {2}, "it must be [width, height]");
    return size.empty() ? Size{} : Size{whole(reader, "image_size", size[0]), whole(reader, "image_size", size[1])};
  }
  const auto width = reader.take("image_width", {1}, kAdvice);
  const auto height = reader.take("image_height", {1}, kAdvice);
  if (width.empty() || height.empty()) return {};
  return {whole(reader, "image_width", width[0]), whole(reader, "image_height", height[0])};
}

Camera read_camera(OpencvReader& reader, const char* matrix_key, const char* distortion_key) {
  Camera camera;
  const auto m = reader.take(matrix_key, {9}, "a 3x3 camera matrix is needed");
  const auto d = reader.take(distortion_key, {4, 5, 8}, "calibrate with a model of 4, 5 or 8 distortion coefficients");
  if (m.empty() || d.empty()) return camera;
  if (m[1] != 0 || m[3] != 0 || m[6] != 0 || m[7] != 0 || m[8] != 1)
    reader.complain(fmt::format("key '{}' is not [fx 0 cx; 0 fy cy; 0 0 1]", matrix_key));
  camera.fx_px = m[0];
  camera.cx_px = m[2];
  camera.fy_px = m[4];
  camera.cy_px = m[5];
  std::copy(d.begin(), d.end(), camera.distortion.begin());
  return camera;
}

Result<Rig> rig_from_numbers(const Numbers& numbers, const std::string& name) {
  const auto* spelling = std::find_if(std::begin(kSpellings), std::end(kSpellings), [&](const Spelling& s) {
    return numbers.contains(s.left_matrix) || numbers.contains(s.right_matrix);
  });
  if (spelling == std::end(kSpellings))
    return rig_error(name, "it has no camera matrices (cameraMatrix1, M1 or camera_matrix_left); give a stereo calibration");
  Rig rig;
  OpencvReader reader(numbers);
  rig.left = read_camera(reader, spelling->left_matrix, spelling->left_distortion);
  rig.right = read_camera(reader, spelling->right_matrix, spelling->right_distortion);
  constexpr const char* kPose = "the file must hold R (3x3) and T (3x1, metres) beside the camera matrices";
  const auto r = reader.take("R", {9}, kPose);
  const auto t = reader.take("T", {3}, kPose);
  rig.left.size = rig.right.size = read_size(reader, numbers);
  if (!reader.wrong().empty()) return rig_error(name, "{}", reader.wrong());
  std::copy(r.begin(), r.end(), rig.right_from_left.rotation.m.begin());
  rig.right_from_left.t_m = {t[0], t[1], t[2]};
  return rig;
}

}  // namespace

Result<Rig> rig_from_opencv_json(const nlohmann::json& json, const std::string& name) {
  DUO_TRY_ASSIGN(const Numbers numbers, numbers_from_json(json, name));
  return rig_from_numbers(numbers, name);
}

Result<Rig> rig_from_opencv_yaml(const YAML::Node& map, const std::string& name) {
  DUO_TRY_ASSIGN(const Numbers numbers, numbers_from_yaml(map, name));
  return rig_from_numbers(numbers, name);
}

}  // namespace duo
