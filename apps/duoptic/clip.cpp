#include "clip.h"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "duoptic/sink.h"

namespace duo::app {
namespace {

namespace fs = std::filesystem;

/// Throws nlohmann::json::exception where something is missing or of another kind.
JointTruth joint_of(const nlohmann::json& j) {
  JointTruth joint;
  const auto& xyz = j.at("xyz");
  joint.p_in_left_m = {xyz.at(0).get<double>(), xyz.at(1).get<double>(), xyz.at(2).get<double>()};
  joint.visible = j.at("vis_left").get<bool>() && j.at("vis_right").get<bool>();
  if (const auto& uv = j.at("uv_left"); !uv.is_null()) {
    joint.u_px = uv.at(0).get<double>();
    joint.v_px = uv.at(1).get<double>();
  }
  return joint;
}

std::vector<ArmTruth> frames_of(const nlohmann::json& truth) {
  const std::string arm = truth.at("meta").at("selected_arm").get<std::string>();
  std::vector<ArmTruth> frames;
  for (const auto& frame : truth.at("frames")) {
    ArmTruth& joints = frames.emplace_back();
    for (std::size_t j = 0; j < kArmJoints; ++j)
      joints[j] = joint_of(frame.at("joints").at(fmt::format("{}_{}", arm, kJointNames[j])));
  }
  return frames;
}

}  // namespace

std::int64_t ClipTruth::first_visible() const {
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (frames[i][0].visible && frames[i][1].visible && frames[i][2].visible) return static_cast<std::int64_t>(i);
  return -1;
}

Result<ClipTruth> load_clip(const fs::path& folder) {
  ClipTruth clip;
  clip.name = fs::weakly_canonical(folder).filename().string();
  DUO_TRY_ASSIGN(clip.rig, load_rig(folder / "calibration_truth.yml"));
  const fs::path path = folder / "truth.json";
  std::ifstream file(path);
  if (!file)
    return Error{ErrorCode::kNotFound,
                 fmt::format("cannot evaluate {}: it has no truth.json that can be read", folder.string())};
  try {
    const nlohmann::json truth = nlohmann::json::parse(file);
    clip.skew_ms = truth.at("meta").value("skew_ms", 0.0);
    clip.frames = frames_of(truth);
  } catch (const nlohmann::json::exception& error) {
    return Error{ErrorCode::kBadInput, fmt::format("cannot use {}: {}", path.string(), error.what())};
  }
  if (clip.first_visible() < 0)
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot evaluate {}: no frame shows hand, elbow and shoulder of the selected arm to both cameras",
                             folder.string())};
  return clip;
}

Result<DepthTruth> load_depth(const fs::path& folder, std::int64_t frame) {
  const fs::path depth = folder / fmt::format("depth/depth_{:04}.png", frame);
  const fs::path figure = folder / fmt::format("depth/figure_{:04}.png", frame);
  DepthTruth truth;
  if (!fs::exists(depth) || !fs::exists(figure)) return truth;
  DUO_TRY_ASSIGN(truth.z_tenth_mm, read_png16(depth));
  DUO_TRY_ASSIGN(const Image<std::uint16_t> mask, read_png16(figure));
  if (mask.size() != truth.z_tenth_mm.size())
    return Error{ErrorCode::kBadInput, fmt::format("cannot use {}: its size differs from {}", figure.string(), depth.string())};
  truth.figure = Image<std::uint8_t>(mask.size());
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) truth.figure.at(y, x) = mask.at(y, x) > 127 ? 255 : 0;
  return truth;
}

}  // namespace duo::app
