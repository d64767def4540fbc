// OpenCV's calibration files. All three syntaxes are first reduced to named lists of numbers; one reader serves them all.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <pugixml.hpp>
#include <vector>

#include "calib/rig_formats.h"
#include "calib/yaml_reader.h"

namespace duo {
namespace {

constexpr const char* kCoefficientsAdvice = "calibrate with a pinhole model of 4, 5 or 8 distortion coefficients";

struct Spelling {
  const char *left_matrix, *left_distortion, *right_matrix, *right_distortion;
};
constexpr Spelling kSpellings[] = {
    {"cameraMatrix1", "distCoeffs1", "cameraMatrix2", "distCoeffs2"},
    {"M1", "D1", "M2", "D2"},
    {"camera_matrix_left", "dist_coeffs_left", "camera_matrix_right", "dist_coeffs_right"},
    {"K1", "D1", "K2", "D2"},
    {"mtxL", "distL", "mtxR", "distR"},
    {"K_left", "D_left", "K_right", "D_right"},
};

bool is_known(std::string_view key) {
  if (key == "image_width" || key == "image_height" || key == "image_size" || key == "R" || key == "T") return true;
  return std::any_of(std::begin(kSpellings), std::end(kSpellings), [&](const Spelling& s) {
    return key == s.left_matrix || key == s.left_distortion || key == s.right_matrix || key == s.right_distortion;
  });
}

/// Keys under which programs name their lens model.
bool is_model(std::string_view key) { return key.ends_with("model") || key == "model_type"; }

/// One key of a file: a text, numbers, or neither.
struct Entry {
  std::string key, text;
  std::optional<std::vector<double>> numbers;
};

// A list holds numbers, or rows of numbers as people write them by hand.
bool append_numbers(const nlohmann::json& node, int depth, std::vector<double>& out) {
  if (node.is_number()) {
    out.push_back(node.get<double>());
    return out.size() <= kMaxNumbers;
  }
  if (depth == 2 || !node.is_array() || node.size() > kMaxNumbers) return false;
  return std::all_of(node.begin(), node.end(), [&](const auto& item) { return append_numbers(item, depth + 1, out); });
}

Result<std::vector<Entry>> entries_of_yaml(std::string_view text, const std::string& name) {
  DUO_TRY_ASSIGN(const std::vector<YAML::Node> documents, yaml_documents(text, name));
  std::vector<Entry> entries;
  try {
    for (const auto& entry : documents.front()) {
      if (!entry.first.IsScalar()) continue;
      Entry& added = entries.emplace_back(Entry{entry.first.Scalar(), {}, {}});
      if (entry.second.IsScalar()) added.text = entry.second.Scalar();
      if (std::vector<double> numbers; read_numbers(entry.second, numbers)) added.numbers = std::move(numbers);
    }
  } catch (const YAML::Exception& e) {  // nodes that look sound can still throw when they are asked for what they are not
    return rig_error(name, "the YAML is broken ({}); write the file again", e.msg);
  }
  return entries;
}

Result<std::vector<Entry>> entries_of_json(std::string_view text, const std::string& name) {
  const auto json = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (json.is_discarded()) return rig_error(name, "the JSON is broken or cut short; write the file again");
  std::vector<Entry> entries;
  for (const auto& [key, value] : json.items()) {
    Entry& added = entries.emplace_back(Entry{key, {}, {}});
    if (value.is_string()) added.text = value.get<std::string>();
    const bool matrix = value.is_object();
    std::vector<double> numbers;
    if ((!matrix || value.contains("data")) && append_numbers(matrix ? value["data"] : value, 0, numbers))
      added.numbers = std::move(numbers);
  }
  return entries;
}

Result<std::vector<Entry>> entries_of_xml(std::string_view text, const std::string& name) {
  pugi::xml_document document;
  if (!document.load_buffer(text.data(), text.size()))
    return rig_error(name, "the XML is broken or cut short; write the file again");
  const pugi::xml_node root = document.child("opencv_storage");
  if (!root) return rig_error(name, "this XML is not OpenCV's; give what its FileStorage wrote");
  std::vector<Entry> entries;
  for (const pugi::xml_node& node : root.children()) {
    const pugi::xml_node data = node.child("data");
    Entry& added = entries.emplace_back(Entry{node.name(), node.text().get(), {}});
    if (!is_known(added.key) && !is_model(added.key)) continue;
    if (std::vector<double> numbers; read_numbers(std::string_view(data ? data.text().get() : node.text().get()), numbers))
      added.numbers = std::move(numbers);
  }
  return entries;
}

Result<std::vector<Entry>> entries_of(std::string_view text, const std::string& name) {
  if (text.front() == '{') return entries_of_json(text, name);
  if (text.front() == '<') return entries_of_xml(text, name);
  return entries_of_yaml(text, name);
}

/// The name of a lens model that is not Brown's; empty where there is none.
std::string other_model(const Entry& entry) {
  if (entry.key == "fisheye_model") return entry.numbers && *entry.numbers == std::vector{0.0} ? "" : "fisheye";
  constexpr const char* kOthers[] = {"fisheye", "equidistant", "kannala", "omni"};
  std::string text = entry.text;
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  const bool other =
      std::any_of(std::begin(kOthers), std::end(kOthers), [&](const char* model) { return text.find(model) != text.npos; });
  return other ? entry.text : "";
}

/// Finds named lists of the right length and keeps the first thing that is wrong.
class OpencvReader {
 public:
  explicit OpencvReader(const OpencvNumbers& numbers) : numbers_(numbers) {}
  const std::string& wrong() const { return wrong_; }

  /// Empty also when the key is missing or has another count than the allowed ones.
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
  const OpencvNumbers& numbers_;
  std::string wrong_;
};

int whole(OpencvReader& reader, const char* key, double value) {
  if (!(value == std::floor(value)) || std::abs(value) > 1e6)
    reader.complain(fmt::format("key '{}' is {}, not a size in pixels", key, value));
  return reader.wrong().empty() ? static_cast<int>(value) : 0;
}

/// Where the file does not say it: the size given.
Size read_size(OpencvReader& reader, const OpencvNumbers& numbers, Size given) {
  constexpr const char* kAdvice =
      "give the size of the calibrated pictures: image_width and image_height, image_size, or duoptic rig import --size WxH";
  if (numbers.contains("image_size")) {
    const auto size = reader.take("image_size", {2}, "it must be [width, height]");
    return size.empty() ? Size{} : Size{whole(reader, "image_size", size[0]), whole(reader, "image_size", size[1])};
  }
  if (given.width > 0 && !numbers.contains("image_width") && !numbers.contains("image_height")) return given;
  const auto width = reader.take("image_width", {1}, kAdvice);
  const auto height = reader.take("image_height", {1}, kAdvice);
  if (width.empty() || height.empty()) return {};
  return {whole(reader, "image_width", width[0]), whole(reader, "image_height", height[0])};
}

Camera read_camera(OpencvReader& reader, const char* matrix_key, const char* distortion_key) {
  Camera camera;
  const auto m = reader.take(matrix_key, {9}, "a 3x3 camera matrix is needed");
  const auto d = reader.take(distortion_key, {0, 4, 5, 8, 12, 14}, kCoefficientsAdvice);
  if (m.empty()) return camera;
  if (m[2] == 0 && m[5] == 0 && m[6] != 0)
    reader.complain(
        fmt::format("key '{}' is [fx 0 0; 0 fy 0; cx cy 1], as MATLAB writes it: transpose it, and R too", matrix_key));
  if (m[1] != 0 || m[3] != 0 || m[6] != 0 || m[7] != 0 || m[8] != 1)
    reader.complain(fmt::format("key '{}' is not [fx 0 cx; 0 fy cy; 0 0 1]", matrix_key));
  camera.fx_px = m[0];
  camera.cx_px = m[2];
  camera.fy_px = m[4];
  camera.cy_px = m[5];
  if (const std::string wrong = put_coefficients(d, camera); !wrong.empty())
    reader.complain(fmt::format("key '{}' {}", distortion_key, wrong));
  return camera;
}

}  // namespace

std::string put_coefficients(std::span<const double> numbers, Camera& camera) {
  const std::size_t used = std::min(numbers.size(), camera.distortion.size());
  if (std::any_of(numbers.begin() + static_cast<std::ptrdiff_t>(used), numbers.end(), [](double value) { return value != 0; }))
    return fmt::format("has {} coefficients, and those after the eighth (thin prism, tilt) are not 0; {}", numbers.size(),
                       kCoefficientsAdvice);
  std::copy_n(numbers.begin(), used, camera.distortion.begin());
  return {};
}

Result<OpencvNumbers> opencv_numbers(std::string_view text, const std::string& name) {
  DUO_TRY_ASSIGN(const std::vector<Entry> entries, entries_of(text, name));
  OpencvNumbers numbers;
  for (const Entry& entry : entries) {
    if (is_model(entry.key))
      if (const std::string model = other_model(entry); !model.empty())
        return rig_error(name, "lens model '{}' is not read; {}", model, kCoefficientsAdvice);
    if (!is_known(entry.key)) continue;
    if (!entry.numbers) return rig_error(name, "key '{}' is not a matrix of at most {} numbers", entry.key, kMaxNumbers);
    numbers[entry.key] = *entry.numbers;
  }
  return numbers;
}

Result<Rig> rig_from_opencv(const OpencvNumbers& numbers, const std::string& name, Size size) {
  const auto* spelling = std::find_if(std::begin(kSpellings), std::end(kSpellings), [&](const Spelling& s) {
    return numbers.contains(s.left_matrix) || numbers.contains(s.right_matrix);
  });
  if (spelling == std::end(kSpellings)) {
    if (numbers.contains("R"))
      return rig_error(name,
                       "it has a pose, but no camera matrices (cameraMatrix1, M1, K1 or camera_matrix_left); if they are in "
                       "another file: duoptic rig import intrinsics.yml extrinsics.yml");
    return rig_error(name,
                     "it has no camera matrices (cameraMatrix1, M1, K1 or camera_matrix_left); give a stereo calibration");
  }
  Rig rig;
  OpencvReader reader(numbers);
  rig.left = read_camera(reader, spelling->left_matrix, spelling->left_distortion);
  rig.right = read_camera(reader, spelling->right_matrix, spelling->right_distortion);
  constexpr const char* kPose =
      "R (3x3) and T (3x1, metres) must stand beside the camera matrices, or in a second file: duoptic rig import "
      "intrinsics.yml extrinsics.yml";
  const auto r = reader.take("R", {9}, kPose);
  const auto t = reader.take("T", {3}, kPose);
  rig.left.size = rig.right.size = read_size(reader, numbers, size);
  if (!reader.wrong().empty()) return rig_error(name, "{}", reader.wrong());
  std::copy(r.begin(), r.end(), rig.right_from_left.rotation.m.begin());
  rig.right_from_left.t_m = {t[0], t[1], t[2]};
  return rig;
}

std::vector<Size> likely_sizes(Vec2 left_centre_px, Vec2 right_centre_px) {
  // How far a webcam's principal point lies from the middle of its picture at most, in parts of the width or height.
  constexpr double kOffCentre = 0.07;
  constexpr Size kSizes[] = {{320, 240},   {424, 240},   {640, 360},   {640, 400},   {640, 480},   {752, 480},   {800, 600},
                             {848, 480},   {960, 540},   {1024, 768},  {1280, 720},  {1280, 800},  {1280, 960},  {1280, 1024},
                             {1600, 1200}, {1920, 1080}, {1920, 1200}, {2304, 1296}, {2560, 1440}, {2592, 1944}, {3840, 2160}};
  const auto in_middle = [](Vec2 centre_px, Size size) {
    return std::abs(centre_px.x / size.width - 0.5) < kOffCentre && std::abs(centre_px.y / size.height - 0.5) < kOffCentre;
  };
  std::vector<Size> likely;
  for (const Size size : kSizes)
    if (in_middle(left_centre_px, size) && in_middle(right_centre_px, size)) likely.push_back(size);
  return likely;
}

std::vector<Size> likely_sizes(const OpencvNumbers& numbers) {
  std::vector<Vec2> centres_px;
  for (const Spelling& s : kSpellings)
    for (const char* key : {s.left_matrix, s.right_matrix})
      if (const auto found = numbers.find(key); found != numbers.end() && found->second.size() == 9)
        centres_px.push_back({found->second[2], found->second[5]});
  return centres_px.size() == 2 ? likely_sizes(centres_px[0], centres_px[1]) : std::vector<Size>();
}

}  // namespace duo
