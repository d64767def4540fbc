#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "calib/rig_formats.h"
#include "core/json_text.h"

namespace duo {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* kSchema = "duoptic.rig";
constexpr int kVersion = 1;

/// Takes values out of a JSON document and keeps the first thing that is wrong.
class JsonReader {
 public:
  explicit JsonReader(const nlohmann::json& json) : json_(json) {}
  const std::string& wrong() const { return wrong_; }

  bool has(const std::string& key) const { return json_.contains(nlohmann::json::json_pointer("/" + key)); }
  void text(const std::string& key, std::string& out) { take(key, "a text", &nlohmann::json::is_string, out); }
  void truth(const std::string& key, bool& out) { take(key, "true or false", &nlohmann::json::is_boolean, out); }
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

void read_camera(JsonReader& reader, const std::string& side, Camera& camera) {
  reader.integer(side + "/width", camera.size.width);
  reader.integer(side + "/height", camera.size.height);
  reader.number(side + "/fx_px", camera.fx_px);
  reader.number(side + "/fy_px", camera.fy_px);
  reader.number(side + "/cx_px", camera.cx_px);
  reader.number(side + "/cy_px", camera.cy_px);
  reader.numbers(side + "/distortion", camera.distortion);
}

void read_errors(JsonReader& reader, RigErrors& errors) {
  reader.number("errors/left_px", errors.left_px);
  reader.number("errors/right_px", errors.right_px);
  reader.number("errors/row_px", errors.row_px);
  reader.number("errors/held_out_px", errors.held_out_px);
  reader.number("errors/held_out_row_px", errors.held_out_row_px);
}

void read_uncertainty(JsonReader& reader, RigUncertainty& sigma) {
  reader.number("uncertainty/left_focal_px", sigma.left_focal_px);
  reader.number("uncertainty/right_focal_px", sigma.right_focal_px);
  reader.number("uncertainty/tilt_rad", sigma.tilt_rad);
  reader.number("uncertainty/pan_rad", sigma.pan_rad);
  reader.number("uncertainty/roll_rad", sigma.roll_rad);
  reader.number("uncertainty/baseline_m", sigma.baseline_m);
  reader.numbers("uncertainty/depth_m", sigma.depth_m);
}

Json json_from_uncertainty(const RigUncertainty& sigma) {
  return {{"left_focal_px", sigma.left_focal_px}, {"right_focal_px", sigma.right_focal_px},
          {"tilt_rad", sigma.tilt_rad},           {"pan_rad", sigma.pan_rad},
          {"roll_rad", sigma.roll_rad},           {"baseline_m", sigma.baseline_m},
          {"depth_at_m", kJudgedDepths_m},        {"depth_m", sigma.depth_m}};
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
  JsonReader reader(json);
  read_camera(reader, "left", rig.left);
  read_camera(reader, "right", rig.right);
  std::array<double, 3> t{};
  reader.numbers("right_from_left/rotation", rig.right_from_left.rotation.m);
  reader.numbers("right_from_left/t_m", t);
  reader.number("reprojection_rms_px", rig.reprojection_rms_px);
  rig.right_from_left.t_m = {t[0], t[1], t[2]};
  if (reader.has("errors")) read_errors(reader, rig.errors);
  if (reader.has("uncertainty")) read_uncertainty(reader, rig.uncertainty.emplace());
  if (reader.has("metric")) reader.truth("metric", rig.metric);
  if (reader.has("time_offset_s")) reader.number("time_offset_s", rig.time_offset_s);
  if (reader.has("left/name")) reader.text("left/name", rig.left_name);
  if (reader.has("right/name")) reader.text("right/name", rig.right_name);
  if (reader.has("date")) reader.text("date", rig.date);
  if (!reader.wrong().empty()) return rig_error(name, "{}", reader.wrong());
  return rig;
}

std::string json_from_rig(const Rig& rig) {
  const Vec3 t = rig.right_from_left.t_m;
  Json json = {{"schema", kSchema},
               {"version", kVersion},
               {"units", "pixels (px), metres (m), radians (rad), seconds (s); centre of the top-left pixel at (0, 0)"},
               {"date", rig.date},
               {"left", json_from_camera(rig.left)},
               {"right", json_from_camera(rig.right)},
               {"right_from_left", {{"rotation", rig.right_from_left.rotation.m}, {"t_m", {t.x, t.y, t.z}}}},
               {"metric", rig.metric},
               {"time_offset_s", rig.time_offset_s},
               {"reprojection_rms_px", rig.reprojection_rms_px},
               {"errors",
                {{"left_px", rig.errors.left_px},
                 {"right_px", rig.errors.right_px},
                 {"row_px", rig.errors.row_px},
                 {"held_out_px", rig.errors.held_out_px},
                 {"held_out_row_px", rig.errors.held_out_row_px}}}};
  json["left"]["name"] = rig.left_name;
  json["right"]["name"] = rig.right_name;
  if (rig.uncertainty) json["uncertainty"] = json_from_uncertainty(*rig.uncertainty);
  return json_text(json) + "\n";
}

}  // namespace duo
