// YAML files come from several programs; the keys tell which.
#include <algorithm>

#include "calib/rig_formats.h"
#include "calib/yaml_reader.h"

namespace duo {
namespace {

struct Document {
  std::string text;
  int first_line = 1;
};

// Parted here, by their lines of dashes: yaml-cpp's own way to read several documents can go on for ever.
std::vector<Document> part(std::string_view text) {
  std::vector<Document> out(1);
  for (int line_number = 1; !text.empty(); ++line_number) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end);
    if (line.substr(0, 3) == "---" && line.find_first_not_of(" \t\r\n", 3) == line.npos)
      out.push_back({{}, line_number + 1});
    else
      out.back().text += line.substr(0, 5) == "%YAML" ? "\n" : line;  // OpenCV's own header is no YAML directive
  }
  return out;
}

Error no_known_kind(const std::string& name) {
  return rig_error(
      name, "this is no rig file of a known kind (ours, OpenCV, ROS, Kalibr, Middlebury, KITTI, ZED); give a calibration file");
}

/// Whether a text that is no YAML was to be a rig: it has a key of one.
bool names_a_camera(std::string_view text) {
  constexpr const char* kKeys[] = {"%YAML", "cam0:", "camera_model:", "distortion_model:", "image_width:", "opencv-matrix"};
  return std::any_of(std::begin(kKeys), std::end(kKeys), [&](const char* key) { return text.find(key) != text.npos; });
}

/// Nodes that look sound can still throw when they are asked for what they are not.
template <class Read>
Result<Rig> guarded(const std::string& name, Read&& read) {
  try {
    return read();
  } catch (const YAML::Exception& e) {
    return rig_error(name, "the YAML is broken ({}); write the file again", e.msg);
  }
}

}  // namespace

Result<std::vector<YAML::Node>> yaml_documents(std::string_view text, const std::string& name) {
  std::vector<YAML::Node> maps;
  for (const Document& document : part(text)) {
    try {
      const YAML::Node node = YAML::Load(document.text);
      if (!node.IsNull()) maps.push_back(node);
    } catch (const YAML::Exception& e) {
      if (!names_a_camera(text)) return no_known_kind(name);
      return rig_error(name, "the YAML is broken or cut short at line {}; write the file again",
                       e.mark.line + document.first_line);
    }
  }
  if (maps.empty() || !std::all_of(maps.begin(), maps.end(), [](const YAML::Node& node) { return node.IsMap(); }))
    return no_known_kind(name);
  return maps;
}

Result<Rig> rig_from_yaml(std::string_view text, const std::string& name, Size size) {
  DUO_TRY_ASSIGN(const std::vector<YAML::Node> documents, yaml_documents(text, name));
  const YAML::Node& first = documents.front();
  return guarded(name, [&]() -> Result<Rig> {
    if (first["cam0"].IsDefined()) return rig_from_kalibr(first, name);
    if (!is_ros_camera(first)) {
      DUO_TRY_ASSIGN(const OpencvNumbers numbers, opencv_numbers(text, name));
      return rig_from_opencv(numbers, name, size);
    }
    if (documents.size() == 2) return rig_from_ros(first, documents[1], name);
    return rig_error(name, "this is the camera_info of one camera; give both files: duoptic rig import LEFT RIGHT");
  });
}

}  // namespace duo
