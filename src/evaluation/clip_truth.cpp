#include "duoptic/evaluation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "duoptic/sink.h"
#include "evaluation/json_file.h"

namespace duo {
namespace {

namespace fs = std::filesystem;

/// Throws nlohmann::json::exception where something is missing or of another kind.
JointTruth joint_of(const nlohmann::json& j, Size picture) {
  JointTruth joint;
  const auto& xyz = j.at("xyz");
  joint.p_in_left_m = {xyz.at(0).get<double>(), xyz.at(1).get<double>(), xyz.at(2).get<double>()};
  joint.visible = j.at("vis_left").get<bool>() && j.at("vis_right").get<bool>();
  if (const auto& uv = j.at("uv_left"); !uv.is_null()) {
    joint.u_px = uv.at(0).get<double>();
    joint.v_px = uv.at(1).get<double>();
    joint.in_picture =
        joint.u_px >= 0 && joint.v_px >= 0 && joint.u_px <= picture.width - 1 && joint.v_px <= picture.height - 1;
  }
  return joint;
}

Side side_named(const std::string& name) { return name == "left" ? Side::kLeft : Side::kRight; }

FrameTruth frame_of(const nlohmann::json& joints, Size picture) {
  FrameTruth truth;
  for (const auto& [name, joint] : joints.items())
    if (const auto id = joint_named(name)) truth[static_cast<std::size_t>(*id)] = joint_of(joint, picture);
  return truth;
}

Error cannot_evaluate(const std::string& name, const std::string& why) {
  return {ErrorCode::kBadInput, fmt::format("cannot evaluate {}: {}", name, why)};
}

fs::path depth_path(const fs::path& folder, std::int64_t frame) { return folder / fmt::format("depth/depth_{:04}.png", frame); }
fs::path figure_path(const fs::path& folder, std::int64_t frame) {
  return folder / fmt::format("depth/figure_{:04}.png", frame);
}

}  // namespace

Result<void> ClipTruth::check(JointId joint) const {
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (!frames[i][static_cast<std::size_t>(joint)])
      return cannot_evaluate(name, fmt::format("frame {} of its truth.json has no {}", i, name_of(joint)));
  return {};
}

Result<std::int64_t> ClipTruth::first_visible(std::span<const JointId> joints) const {
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (std::all_of(joints.begin(), joints.end(), [&](JointId joint) {
          const auto& truth = frames[i][static_cast<std::size_t>(joint)];
          return truth && truth->visible;
        }))
      return static_cast<std::int64_t>(i);
  std::vector<std::string_view> names;
  for (const JointId joint : joints) names.push_back(name_of(joint));
  return cannot_evaluate(name, fmt::format("no frame shows {} to both cameras", fmt::join(names, ", ")));
}

Result<ClipTruth> load_clip(const fs::path& folder) {
  ClipTruth clip;
  std::error_code failed;
  const fs::path whole = fs::weakly_canonical(folder, failed);
  clip.name = failed ? folder.string() : whole.filename().string();
  DUO_TRY_ASSIGN(clip.rig, load_rig(folder / "calibration_truth.yml"));
  const fs::path path = folder / "truth.json";
  DUO_TRY_ASSIGN(const nlohmann::json truth, read_json(path));
  try {
    clip.skew_ms = truth.at("meta").value("skew_ms", 0.0);
    clip.arm = side_named(truth.at("meta").at("selected_arm").get<std::string>());
    for (const auto& frame : truth.at("frames")) {
      clip.frames.push_back(frame_of(frame.at("joints"), clip.rig.left.size));
      if (!frame.contains("others")) continue;
      const auto& others = frame.at("others");
      clip.others.resize(std::max(clip.others.size(), others.size()));
      for (std::size_t k = 0; k < others.size(); ++k)
        clip.others[k].push_back(frame_of(others[k].at("joints"), clip.rig.left.size));
    }
    for (const auto& other : clip.others)
      if (other.size() != clip.frames.size())
        return Error{ErrorCode::kBadInput, fmt::format("cannot use {}: some of its frames lack a person", path.string())};
  } catch (const nlohmann::json::exception& error) {
    return Error{ErrorCode::kBadInput, fmt::format("cannot use {}: {}", path.string(), error.what())};
  }
  return clip;
}

/// A picture that the system does not let us look at counts as there: reading it says why.
bool has_depth_truth(const fs::path& folder, std::int64_t frame) {
  const auto there = [](const fs::path& path) {
    std::error_code failed;
    return fs::exists(path, failed) || failed;
  };
  return there(depth_path(folder, frame)) && there(figure_path(folder, frame));
}

Result<DepthTruth> load_depth_truth(const fs::path& folder, std::int64_t frame) {
  const fs::path depth = depth_path(folder, frame), figure = figure_path(folder, frame);
  DepthTruth truth;
  if (!has_depth_truth(folder, frame)) return truth;
  DUO_TRY_ASSIGN(truth.z_tenth_mm, read_png16(depth));
  DUO_TRY_ASSIGN(const Image<std::uint16_t> mask, read_png16(figure));
  if (mask.size() != truth.z_tenth_mm.size())
    return Error{ErrorCode::kBadInput, fmt::format("cannot use {}: its size differs from {}", figure.string(), depth.string())};
  truth.figure = Image<std::uint8_t>(mask.size());
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) truth.figure.at(y, x) = mask.at(y, x) > 127 ? 255 : 0;
  return truth;
}

}  // namespace duo
