// Exposure, gain and white balance: found by one camera, locked in both.
#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "sources/camera/device.h"

namespace duo {

/// What a camera's automatics settled on; none where the camera lacks the control.
///
/// Units   exposure in 100 us, white balance in K, gain in the camera's own
struct CameraControls {
  std::optional<int> exposure, gain, white_balance;
};

CameraControls read_controls(const CameraDevice& camera);

/// Turns the automatics off and sets these values. What could not be done comes back as words for a warning; empty when the
/// camera has these values now.
std::string lock_controls(CameraDevice& camera, const CameraControls& controls);

/// The same controls for several cameras, each in its thread: the leader gives them, all take them.
class SharedControls {
 public:
  void give(const CameraControls& controls) {
    const std::lock_guard lock(mutex_);
    if (!controls_) controls_ = controls;
  }
  std::optional<CameraControls> get() const {
    const std::lock_guard lock(mutex_);
    return controls_;
  }

 private:
  mutable std::mutex mutex_;
  std::optional<CameraControls> controls_;
};

}  // namespace duo
