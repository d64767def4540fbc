// Cameras as live sources.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "duoptic/source.h"
#include "sources/camera/controls.h"
#include "sources/camera/system_calls.h"

namespace duo {

/// A camera by its name. next() gives its newest picture, stamped with the start of its exposure on the steady clock; it waits
/// 200 ms at most. A camera that is unplugged, or gives no picture for a second, is away: its name stays with the bus path and
/// serial number that it had, and next() goes on looking for that one.
///
/// Errors  those of open_source() for cameras
Result<std::unique_ptr<Source>> open_camera(const SystemCalls& system, const std::string& name, const CameraWish& wish);

/// Two cameras with the same exposure, gain and white balance, in formats that the bus has room for.
///
/// Errors  those of open_camera(); both names are one camera
Result<std::array<std::unique_ptr<Source>, 2>> open_cameras(const SystemCalls& system, const std::string& left,
                                                            const std::string& right, const CameraWish& wish);

}  // namespace duo
