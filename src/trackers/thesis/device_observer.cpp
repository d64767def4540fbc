#include "trackers/thesis/device_observer.h"

#if DUO_VULKAN
#include "trackers/thesis/device_observer_vk.h"
#endif

namespace duo::thesis {

#if DUO_VULKAN
std::unique_ptr<DeviceObserver> make_device_observer() { return std::make_unique<vk::VulkanObserver>(); }
#else
std::unique_ptr<DeviceObserver> make_device_observer() { return nullptr; }
#endif

}  // namespace duo::thesis
