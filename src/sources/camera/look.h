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
struct CameraLook {
  std::optional<int> exposure, gain, white_balance;
};

CameraLook read_look(const CameraDevice& camera);

/// Turns the automatics off and sets these values. What could not be done comes back as words for a warning; empty when the
/// camera now looks like that.
std::string lock_look(CameraDevice& camera, const CameraLook& look);

/// One look for several cameras, each in its thread: the leader gives it, all take it.
class SharedLook {
 public:
  void give(const CameraLook& look) {
    const std::lock_guard lock(mutex_);
    if (!look_) look_ = look;
  }
  std::optional<CameraLook> get() const {
    const std::lock_guard lock(mutex_);
    return look_;
  }

 private:
  mutable std::mutex mutex_;
  std::optional<CameraLook> look_;
};

}  // namespace duo
