// What a camera can give, and which of it to ask for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "duoptic/cameras.h"
#include "sources/camera/system_calls.h"

namespace duo {

/// The format to ask a camera for: one that is read here and has this size, at this rate where there is one. Raw where
/// `raw_fits` and the rate allow, for it has no blocks and costs nothing to decode; else MJPG.
///
/// Errors  no such format: which sizes there are
Result<std::uint32_t> choose_format(const CameraInfo& camera, const CameraWish& wish, bool raw_fits);

/// True when the bus carries raw pictures of one camera, or of two at once. Cameras that cannot say their bus are taken to
/// share one.
bool raw_fits(const CameraInfo& camera, const CameraWish& wish);
bool raw_fits(const CameraInfo& left, const CameraInfo& right, const CameraWish& wish);

/// Where the kernel puts cameras: /dev/video0 to that of kMostDevices - 1, its default.
inline constexpr int kMostDevices = 64;
std::string device_path(int number);

/// All that can be opened, with their modes. `refused`, when given, is why the first of the others could not.
std::vector<CameraInfo> list_cameras(const SystemCalls& system, std::optional<Error>* refused = nullptr);

/// As find_cameras().
Result<std::vector<CameraInfo>> find_cameras(const SystemCalls& system);

/// The device behind camera:0, /dev/video0 or camera:BUS_PATH; `path` itself when it is none of these.
///
/// Errors  no camera on that bus path, with those there are
Result<std::string> camera_path(const SystemCalls& system, const std::string& name);
bool is_camera_name(const std::string& name);

}  // namespace duo
