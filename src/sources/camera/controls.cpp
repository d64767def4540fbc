#include "sources/camera/controls.h"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <algorithm>

namespace duo {
namespace {

std::optional<int> value_of(const CameraDevice& camera, std::uint32_t id) {
  const auto control = camera.control(id);
  return control ? std::optional<int>(control->value) : std::nullopt;
}

/// Sets one value; adds a word of what is missing or out of the camera's range.
void lock(CameraDevice& camera, std::uint32_t id, const std::optional<int>& value, const char* name, std::string& missing) {
  if (!value) return;
  const auto add = [&](const std::string& what) { missing += (missing.empty() ? "" : ", ") + what; };
  const auto control = camera.control(id);
  if (!control) return add(fmt::format("no {}", name));
  const int nearest = std::clamp(*value, control->min, std::max(control->min, control->max));
  if (!camera.set_control(id, nearest)) return add(fmt::format("{} refused", name));
  if (nearest != *value) add(fmt::format("{} {} instead of {}", name, nearest, *value));
}

/// Switches an automatic off; a camera without it has nothing to switch.
void stop(CameraDevice& camera, std::uint32_t id, int off, const char* name, std::string& missing) {
  const auto control = camera.control(id);
  if (control && control->value != off && !camera.set_control(id, off))
    missing += fmt::format("{}automatic {} stays on", missing.empty() ? "" : ", ", name);
}

}  // namespace

CameraControls read_controls(const CameraDevice& camera) {
  return {value_of(camera, V4L2_CID_EXPOSURE_ABSOLUTE), value_of(camera, V4L2_CID_GAIN),
          value_of(camera, V4L2_CID_WHITE_BALANCE_TEMPERATURE)};
}

std::string lock_controls(CameraDevice& camera, const CameraControls& controls) {
  std::string missing;
  // Automatics first: their values are read only, or are overwritten, while they are on.
  stop(camera, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL, "exposure", missing);
  stop(camera, V4L2_CID_EXPOSURE_AUTO_PRIORITY, 0, "frame rate", missing);
  stop(camera, V4L2_CID_AUTOGAIN, 0, "gain", missing);
  stop(camera, V4L2_CID_AUTO_WHITE_BALANCE, 0, "white balance", missing);
  lock(camera, V4L2_CID_EXPOSURE_ABSOLUTE, controls.exposure, "exposure", missing);
  lock(camera, V4L2_CID_GAIN, controls.gain, "gain", missing);
  lock(camera, V4L2_CID_WHITE_BALANCE_TEMPERATURE, controls.white_balance, "white balance", missing);
  if (!controls.exposure && !camera.control(V4L2_CID_EXPOSURE_AUTO))
    missing += missing.empty() ? "no manual exposure" : ", no manual exposure";
  return missing;
}

}  // namespace duo
