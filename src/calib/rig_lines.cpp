// Rigs in files of lines with a key and numbers: data sets and cameras that come calibrated.
//
// Source  Scharstein et al., "High-resolution stereo datasets with subpixel-accurate ground truth", 2014 (Middlebury's
//         calib.txt); Geiger et al., "Vision meets robotics: the KITTI dataset", 2013; Stereolabs' SN*.conf, whose rotation
//         vector is (RX, CV, RZ) and whose translation leads from the left camera to the right one
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "calib/rig_formats.h"
#include "calib/yaml_reader.h"

namespace duo {
namespace {

constexpr double kMillimetre_m = 1e-3;

/// The numbers of each line by its key; in an INI file SECTION.KEY. What is no such line is passed over.
using Lines = std::map<std::string, std::vector<double>, std::less<>>;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
  return text.substr(0, text.find_last_not_of(kSpace) + 1);
}

Lines lines_of(std::string_view text) {
  Lines lines;
  std::string section;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.starts_with('[') && line.ends_with(']')) {
      section = std::string(line.substr(1, line.size() - 2)) + ".";
      continue;
    }
    const std::size_t parting = line.find_first_of("=:");
    if (parting == line.npos) continue;
    std::vector<double> numbers;
    if (read_numbers(line.substr(parting + 1), numbers))
      lines.insert_or_assign(section + std::string(trimmed(line.substr(0, parting))), std::move(numbers));
  }
  return lines;
}

/// Takes lists of a given length out of the lines and keeps the first key that is wrong.
class LineReader {
 public:
  LineReader(const Lines& lines, const std::string& name) : lines_(lines), name_(name) {}

  std::vector<double> numbers(const std::string& key, std::size_t count) {
    const auto found = lines_.find(key);
    if (found != lines_.end() && found->second.size() == count) return found->second;
    if (!wrong_)
      wrong_ = found == lines_.end()
                   ? rig_error(name_, "key '{}' is missing; give the whole file", key)
                   : rig_error(name_, "key '{}' has {} numbers, not {}; give the whole file", key, found->second.size(), count);
    return std::vector<double>(count);
  }
  double number(const std::string& key) { return numbers(key, 1)[0]; }
  double number_or_0(const std::string& key) { return lines_.contains(key) ? number(key) : 0; }
  int pixels(double value) {
    if (!wrong_ && !(value == std::floor(value) && value > 0 && value <= 1 << 20))
      wrong_ = rig_error(name_, "a picture {} px wide or high cannot be", value);
    return wrong_ ? 0 : static_cast<int>(value);
  }
  const std::optional<Error>& wrong() const { return wrong_; }

 private:
  const Lines& lines_;
  const std::string& name_;
  std::optional<Error> wrong_;
};

Camera pinhole(Size size, std::span<const double> k, std::size_t columns) {
  return {.size = size, .fx_px = k[0], .fy_px = k[columns + 1], .cx_px = k[2], .cy_px = k[columns + 2]};
}

// --- Middlebury -----------------------------------------------------------------------------------------------------------

/// A rectified pair: two camera matrices whose centres differ by doffs, and a baseline in millimetres.
Result<Rig> rig_from_middlebury(const Lines& lines, const std::string& name) {
  LineReader reader(lines, name);
  const Size size = {reader.pixels(reader.number("width")), reader.pixels(reader.number("height"))};
  const std::vector<double> left = reader.numbers("cam0", 9), right = reader.numbers("cam1", 9);
  Rig rig;
  rig.left = pinhole(size, left, 3);
  rig.right = pinhole(size, right, 3);
  rig.right_from_left.t_m.x = -kMillimetre_m * reader.number("baseline");
  if (reader.wrong()) return *reader.wrong();
  return rig;
}

// --- KITTI ----------------------------------------------------------------------------------------------------------------

/// Two projections of a rectified pair, as a file names them.
struct KittiPair {
  const char *left, *right, *size;  // size: null where the file does not say it
  int first;                        // number of the left camera
};
constexpr KittiPair kKittiPairs[] = {{"P_rect_02", "P_rect_03", "S_rect_02", 2},
                                     {"P2", "P3", nullptr, 2},
                                     {"P_rect_00", "P_rect_01", "S_rect_00", 0},
                                     {"P0", "P1", nullptr, 0}};

/// The pair in colour, cameras 2 and 3, whose pictures most downloads hold; where the file has the gray pair alone, that one.
const KittiPair* kitti_pair(const Lines& lines) {
  const auto* found = std::find_if(std::begin(kKittiPairs), std::end(kKittiPairs),
                                   [&](const KittiPair& pair) { return lines.contains(pair.left); });
  return found == std::end(kKittiPairs) ? nullptr : found;
}

/// calib_cam_to_cam.txt says the size of the pictures, the odometry's calib.txt does not.
Result<Rig> rig_from_kitti(const Lines& lines, const KittiPair& pair, const std::string& name, Size size) {
  LineReader reader(lines, name);
  const std::vector<double> left = reader.numbers(pair.left, 12), right = reader.numbers(pair.right, 12);
  if (pair.size != nullptr) {
    const std::vector<double> s = reader.numbers(pair.size, 2);
    size = {reader.pixels(s[0]), reader.pixels(s[1])};
  }
  if (reader.wrong()) return *reader.wrong();
  if (size.width == 0)
    return rig_error(name,
                     "KITTI's file does not say how large the pictures are; add their size: duoptic rig import {} --size "
                     "1242x375",
                     name);
  if (!(left[0] > 0))
    return rig_error(name, "the focal length of camera {} is {} px; give the whole file", pair.first, left[0]);
  Rig rig;
  rig.left = pinhole(size, left, 4);
  rig.right = pinhole(size, right, 4);
  rig.left_name = fmt::format("KITTI camera {}", pair.first);
  rig.right_name = fmt::format("KITTI camera {}", pair.first + 1);
  rig.right_from_left.t_m.x = (right[3] - left[3]) / left[0];
  return rig;
}

// --- ZED ------------------------------------------------------------------------------------------------------------------

struct ZedSize {
  const char* name;
  Size size;
};
constexpr ZedSize kZedSizes[] = {{"2K", {2208, 1242}}, {"FHD", {1920, 1080}}, {"FHD1200", {1920, 1200}}, {"HD", {1280, 720}},
                                 {"SVGA", {960, 600}}, {"VGA", {672, 376}},   {"4k", {3856, 2180}}};

/// Source  Rodrigues: a rotation by the length of `v` around it
Mat3 rotation_around(Vec3 v) {
  const double angle = norm(v);
  if (angle == 0) return {};
  const Vec3 k = (1 / angle) * v;
  const double s = std::sin(angle), c = std::cos(angle), d = 1 - c;
  return Mat3::from_rows({c + d * k.x * k.x, d * k.x * k.y - s * k.z, d * k.x * k.z + s * k.y},
                         {d * k.y * k.x + s * k.z, c + d * k.y * k.y, d * k.y * k.z - s * k.x},
                         {d * k.z * k.x - s * k.y, d * k.z * k.y + s * k.x, c + d * k.z * k.z});
}

Camera zed_camera(LineReader& reader, const std::string& section, Size size) {
  Camera camera = {.size = size,
                   .fx_px = reader.number(section + ".fx"),
                   .fy_px = reader.number(section + ".fy"),
                   .cx_px = reader.number(section + ".cx"),
                   .cy_px = reader.number(section + ".cy")};
  constexpr const char* kOrder[] = {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
  for (std::size_t i = 0; i < camera.distortion.size(); ++i)
    camera.distortion[i] = reader.number_or_0(section + "." + kOrder[i]);
  return camera;
}

Result<Rig> rig_from_zed(const Lines& lines, const std::string& name, Size size) {
  std::vector<std::string> there;
  const ZedSize* chosen = nullptr;
  for (const ZedSize& zed : kZedSizes) {
    if (!lines.contains(fmt::format("LEFT_CAM_{}.fx", zed.name))) continue;
    there.push_back(fmt::format("{}x{}", zed.size.width, zed.size.height));
    if (zed.size == size) chosen = &zed;
  }
  if (chosen == nullptr)
    return rig_error(name,
                     "a ZED's file holds a calibration per size of picture{}; say which: duoptic rig import {} --size WxH",
                     there.empty() ? "" : fmt::format(" ({})", fmt::join(there, ", ")), name);
  LineReader reader(lines, name);
  Rig rig;
  rig.left = zed_camera(reader, fmt::format("LEFT_CAM_{}", chosen->name), size);
  rig.right = zed_camera(reader, fmt::format("RIGHT_CAM_{}", chosen->name), size);
  const auto turn = [&](const char* key) { return reader.number(fmt::format("STEREO.{}_{}", key, chosen->name)); };
  rig.right_from_left.rotation = rotation_around({turn("RX"), turn("CV"), turn("RZ")});
  const Vec3 way_mm = {reader.number("STEREO.Baseline"), reader.number_or_0("STEREO.TY"), reader.number_or_0("STEREO.TZ")};
  rig.right_from_left.t_m = -kMillimetre_m * way_mm;
  if (reader.wrong()) return *reader.wrong();
  return rig;
}

}  // namespace

bool is_rig_of_lines(std::string_view text) {
  if (text.starts_with("%YAML")) return false;  // OpenCV's files have a P2, too
  constexpr const char* kStarts[] = {"cam0=", "cam0 =", "P_rect_00:", "P_rect_02:", "P0:", "P2:", "[LEFT_CAM_"};
  return std::any_of(std::begin(kStarts), std::end(kStarts), [&](const char* start) {
    const std::size_t at = text.find(start);
    return at != text.npos && (at == 0 || text[at - 1] == '\n');
  });
}

Result<Rig> rig_from_lines(std::string_view text, const std::string& name, Size size) {
  const Lines lines = lines_of(text);
  if (lines.contains("cam0")) return rig_from_middlebury(lines, name);
  if (const KittiPair* pair = kitti_pair(lines)) return rig_from_kitti(lines, *pair, name, size);
  return rig_from_zed(lines, name, size);
}

}  // namespace duo
