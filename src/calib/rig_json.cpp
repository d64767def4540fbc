#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "calib/rig_formats.h"

namespace duo {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* kSchema = "duoptic.rig";
constexpr int kVersion = 1;

/// Takes values out of a JSON document and keeps the first thing that is wrong.
class Reader {
 public:
  explicit Reader(const nlohmann::json& json) : json_(json) {}
  const std::string& wrong() const { return wrong_; }

  void number(const std::string& key, double& out) { take(key, "a number", &nlohmann::json::is_number, out); }
  void integer(const std::string& key, int& out) {
    std::int64_t wide = 0;
    take(key, "a whole number", &nlohmann::json::is_number_integer, wide);
    out = static_cast<int>(std::clamp<std::int64_t>(wide, -1, 1 << 30));  // check_rig() refuses both ends
  }
  template <std::size_t N>
  void numbers(const std::string& key, std::array<double, N>& out) {
    const nlohmann::json* list = find(key);
    if (!list) return;
    const bool fits = list->is_array() && list->size() == N &&
                      std::all_of(list->begin(), list->end(), [](const auto& v) { return v.is_number(); });
    if (!fits) return complain("key '" + key + "' must be a list of " + std::to_string(N) + " numbers");
    for (std::size_t i = 0; i < N; ++i) out[i] = (*list)[i].template get<double>();
  }

 private:
  const nlohmann::json* find(const std::string& key) {
    const nlohmann::json::json_pointer pointer("/" + key);
    if (json_.contains(pointer)) return &json_.at(pointer);
    complain("key '" + key + "' is missing");
    return nullptr;
  }
  template <class T>
  void take(const std::string& key, const char* kind, bool (nlohmann::json::*is)() const noexcept, T& out) {
    const nlohmann::json* value = find(key);
    if (!value) return;
    if (!(value->*is)()) return complain("key '" + key + "' must be " + kind);
    out = value->get<T>();
  }
  void complain(std::string what) {
    if (wrong_.empty()) wrong_ = std::move(what);
  }

  const nlohmann::json& json_;
  std::string wrong_;
};

void read_camera(Reader& reader, const std::string& side, Camera& camera) {
  reader.integer(side + "/width", camera.size.width);
  reader.integer(side + "/height", camera.size.height);
  reader.number(side + "/fx_px", camera.fx_px);
  reader.number(side + "/fy_px", camera.fy_px);
  reader.number(side + "/cx_px", camera.cx_px);
  reader.number(side + "/cy_px", camera.cy_px);
  reader.numbers(side + "/distortion", camera.distortion);
}

Json json_from_camera(const Camera& camera) {
  return {{"width", camera.size.width},     {"height", camera.size.height}, {"fx_px", camera.fx_px},
          {"fy_px", camera.fy_px},          {"cx_px", camera.cx_px},        {"cy_px", camera.cy_px},
          {"distortion", camera.distortion}};
}

}  // namespace

Result<Rig> rig_from_json(const nlohmann::json& json, const std::string& name) {
  if (json["schema"] != kSchema) return rig_error(name, "its schema is not \"{}\"", kSchema);
  if (!json.contains("version") || json["version"] != kVersion)
    return rig_error(name, "only version {} of this format is known; write it with this program's version", kVersion);
  Rig rig;
  Reader reader(json);
  read_camera(reader, "left", rig.left);
  read_camera(reader, "right", rig.right);
  std::array<double, 3> t{};
  reader.numbers("right_from_left/rotation", rig.right_from_left.rotation.m);
  reader.numbers("right_from_left/t_m", t);
  reader.number("reprojection_rms_px", rig.reprojection_rms_px);
  rig.right_from_left.t_m = {t[0], t[1], t[2]};
  if (!reader.wrong().empty()) return rig_error(name, "{}", reader.wrong());
  return rig;
}

std::string json_from_rig(const Rig& rig) {
  const Vec3 t = rig.right_from_left.t_m;
  const Json json = {{"schema", kSchema},
                     {"version", kVersion},
                     {"left", json_from_camera(rig.left)},
                     {"right", json_from_camera(rig.right)},
                     {"right_from_left", {{"rotation", rig.right_from_left.rotation.m}, {"t_m", {t.x, t.y, t.z}}}},
                     {"reprojection_rms_px", rig.reprojection_rms_px}};
  return json.dump(2) + "\n";
}

}  // namespace duo
