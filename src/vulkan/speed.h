// How fast a device copies: the lower bound of the time of a stage that moves so many bytes.
#pragma once

#include "duoptic/devices.h"
#include "vulkan/device.h"

namespace duo::vk {

/// Medians of nine copies of 64 MiB each way; reads and writes of a copy on the device count once each.
///
/// Errors  out of memory, device lost
Result<DeviceSpeed> copy_speed(Device& device);

}  // namespace duo::vk
