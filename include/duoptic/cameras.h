// Cameras that are plugged in: what they are called and what they give.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "duoptic/result.h"
#include "duoptic/source.h"

namespace [[gnu::visibility("default")]] duo {

/// A size that a camera gives in one format.
struct CameraMode {
  std::string format;  // four letters: YUYV is raw, MJPG a JPEG a picture
  Size size;
  std::vector<double> rates_hz;  // highest first; empty when the driver does not say
};

struct CameraInfo {
  std::string path;      // /dev/video0
  std::string name;      // of the model
  std::string bus_path;  // where it is plugged in: stays when it is unplugged and comes back under another number
  std::string serial;    // empty when it has none
  int usb_mbit_s = 0;    // 0: unknown, or not on USB
  std::vector<CameraMode> modes;
};

/// All cameras whose device this user may open, by number.
///
/// Errors  none found, or none that may be opened: what to do
Result<std::vector<CameraInfo>> find_cameras();

/// The format in which two cameras can give pictures of this size at this rate together: a raw one when the bus has room for
/// both, else MJPG.
///
/// Errors  they are one camera; one has no format that can be read at this size
Result<std::string> common_format(const CameraInfo& left, const CameraInfo& right, const CameraWish& wish);

/// Two cameras by their place in a list, and the format that both can give together.
struct CameraPair {
  std::size_t left, right;
  std::string format;
};

/// All that can, those of one model first: they see alike.
std::vector<CameraPair> camera_pairs(const std::vector<CameraInfo>& cameras, const CameraWish& wish);

/// "camera:0" for /dev/video0, as open_source() takes it.
std::string source_name(const CameraInfo& camera);

}  // namespace duo
