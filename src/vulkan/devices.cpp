#include "duoptic/devices.h"

#if DUO_VULKAN
#include "vulkan/choose.h"
#include "vulkan/speed.h"
#endif

namespace duo {

Result<std::vector<DeviceInfo>> vulkan_devices() {
#if DUO_VULKAN
  DUO_TRY_ASSIGN(const auto instance, vk::Instance::open(vk::Validation::kOff));
  DUO_TRY_ASSIGN(const auto devices, instance->devices());
  std::vector<DeviceInfo> infos;
  for (const vk::PhysicalDevice& device : devices) infos.push_back(device.info);
  return infos;
#else
  return Error{ErrorCode::kUnsupported, "listing Vulkan devices: this build has no Vulkan: build with -DDUO_VULKAN=ON"};
#endif
}

Result<DeviceSpeed> measure_device([[maybe_unused]] std::string_view wanted) {
#if DUO_VULKAN
  DUO_TRY_ASSIGN(const auto instance, vk::Instance::open(vk::Validation::kOff));
  DUO_TRY_ASSIGN(const auto devices, instance->devices());
  DUO_TRY_ASSIGN(const vk::PhysicalDevice chosen, vk::choose_device(devices, wanted));
  DUO_TRY_ASSIGN(const auto device, vk::Device::make(instance, chosen));
  return vk::copy_speed(*device);
#else
  return Error{ErrorCode::kUnsupported, "measuring a Vulkan device: this build has no Vulkan: build with -DDUO_VULKAN=ON"};
#endif
}

}  // namespace duo
