// Which Vulkan devices this machine has, and what each of them lacks.
#pragma once

#include <string>
#include <vector>

#include "duoptic/result.h"

namespace duo {

struct DeviceInfo {
  std::string name, type, driver, api_version;  // type: discrete, integrated, virtual, software or other
  int subgroup_size = 0;
  std::vector<std::string> lacks;  // of what the Vulkan kernels need; empty: usable
};

/// Every Vulkan device, usable or not; Vulkan itself is looked for at run time.
///
/// Errors  built without Vulkan, no loader, no driver, no device: the reason in one line
Result<std::vector<DeviceInfo>> vulkan_devices();

}  // namespace duo
