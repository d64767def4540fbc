// Which Vulkan devices this machine has, and what each of them lacks.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "duoptic/result.h"

namespace [[gnu::visibility("default")]] duo {

struct DeviceInfo {
  std::string name, type, driver, api_version;  // type: discrete, integrated, virtual, software or other
  int subgroup_size = 0;
  std::vector<std::string> lacks;  // of what the Vulkan kernels need; empty: usable
};

/// Every Vulkan device, usable or not; Vulkan itself is looked for at run time.
///
/// Errors  built without Vulkan, no loader, no driver, no device: the reason in one line
Result<std::vector<DeviceInfo>> vulkan_devices();

/// Rates of copies on a device and between it and the CPU, in GB (1e9 bytes) per second; on the device read and written bytes
/// both count.
struct DeviceSpeed {
  double copy_gb_s = 0, up_gb_s = 0, down_gb_s = 0;
};

/// Measures the device of this index or with this in its name, as Engine::device() says it.
///
/// Errors  no such device, device lost
Result<DeviceSpeed> measure_device(std::string_view wanted);

}  // namespace duo
