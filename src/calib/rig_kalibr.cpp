// Kalibr's camchain.yaml: cam0 is the left camera, cam1 the right one.
//
// Source  github.com/ethz-asl/kalibr, wiki page "YAML formats"; radtan is k1 k2 p1 p2 of Brown's model, T_cn_cnm1 takes points
// from
//         the camera before into this one
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

#include "calib/rig_formats.h"
#include "calib/yaml_reader.h"

namespace duo {
namespace {

constexpr const char* kAllCoefficients = "duoptic_distortion";

Camera read_camera(YamlReader& reader) {
  const std::string model = reader.text("camera_model", "pinhole is read");
  if (reader.wrong().empty() && model != "pinhole")
    reader.complain(fmt::format("camera model '{}' is not read; calibrate with the models pinhole-radtan", model));
  const std::string lens = reader.text("distortion_model", "radtan is read");
  if (reader.wrong().empty() && lens != "radtan")
    reader.complain(fmt::format("distortion model '{}' is not read; calibrate with the models pinhole-radtan", lens));
  const auto size = reader.numbers("resolution", {2}, "it must be [width, height]");
  const auto k = reader.numbers("intrinsics", {4}, "pinhole has fx fy cx cy");
  auto d = reader.numbers("distortion_coeffs", {4}, "radtan has k1 k2 p1 p2");
  if (!reader.key_of({kAllCoefficients}).empty())
    d = reader.numbers(kAllCoefficients, {8}, "k1 k2 p1 p2 k3 k4 k5 k6 are needed");
  if (!reader.wrong().empty()) return {};
  Camera camera{.size = {reader.whole("resolution", size[0]), reader.whole("resolution", size[1])},
                .fx_px = k[0],
                .fy_px = k[1],
                .cx_px = k[2],
                .cy_px = k[3]};
  std::copy(d.begin(), d.end(), camera.distortion.begin());
  return camera;
}

std::string yaml_from_camera(const Camera& camera, const std::array<double, 4>& four) {
  std::string text = fmt::format(
      "  camera_model: pinhole\n  intrinsics: [{}, {}, {}, {}]\n  distortion_model: radtan\n  distortion_coeffs: [{}]\n",
      camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px, fmt::join(four, ", "));
  if (std::any_of(camera.distortion.begin() + 4, camera.distortion.end(), [](double k) { return k != 0; }))
    text += fmt::format("  {}: [{}]\n", kAllCoefficients, fmt::join(camera.distortion, ", "));
  return text + fmt::format("  resolution: [{}, {}]\n", camera.size.width, camera.size.height);
}

}  // namespace

Result<Rig> rig_from_kalibr(const YAML::Node& map, const std::string& name) {
  for (const char* camera : {"cam0", "cam1"})
    if (!map[camera].IsDefined() || !map[camera].IsMap())
      return rig_error(name, "{} is missing; give the camchain of a rig of two cameras", camera);
  if (map["cam2"].IsDefined()) return rig_error(name, "it has more than two cameras; calibrate the pair alone");
  Rig rig;
  YamlReader left(map["cam0"], "cam0: "), right(map["cam1"], "cam1: ");
  rig.left = read_camera(left);
  rig.right = read_camera(right);
  const auto t = right.numbers("T_cn_cnm1", {16}, "the pose from cam0 to cam1 is needed, 4x4 in metres");
  for (const YamlReader* reader : {&left, &right})
    if (!reader->wrong().empty()) return rig_error(name, "{}", reader->wrong());
  if (t[12] != 0 || t[13] != 0 || t[14] != 0 || t[15] != 1)
    return rig_error(name, "cam1: the last row of T_cn_cnm1 is not 0 0 0 1; write the file again");
  rig.right_from_left = {{{t[0], t[1], t[2], t[4], t[5], t[6], t[8], t[9], t[10]}}, {t[3], t[7], t[11]}};
  return rig;
}

std::string kalibr_from_rig(const Rig& rig, const std::array<std::array<double, 4>, 2>& four) {
  const Mat3& r = rig.right_from_left.rotation;
  const Vec3 t = rig.right_from_left.t_m;
  return "cam0:\n  cam_overlaps: [1]\n" + yaml_from_camera(rig.left, four[0]) + "  rostopic: /left/image_raw\n" + "cam1:\n" +
         fmt::format(
             "  T_cn_cnm1:\n  - [{}, {}, {}, {}]\n  - [{}, {}, {}, {}]\n  - [{}, {}, {}, {}]\n  - [0.0, 0.0, 0.0, 1.0]\n",
             r(0, 0), r(0, 1), r(0, 2), t.x, r(1, 0), r(1, 1), r(1, 2), t.y, r(2, 0), r(2, 1), r(2, 2), t.z) +
         "  cam_overlaps: [0]\n" + yaml_from_camera(rig.right, four[1]) + "  rostopic: /right/image_raw\n";
}

}  // namespace duo
