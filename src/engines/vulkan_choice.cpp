// The Vulkan engine by name; a build without Vulkan says so.
#include "engines/engines.h"

#if DUO_VULKAN
#include "vulkan/choose.h"
#include "vulkan/device.h"
#endif

namespace duo {

#if DUO_VULKAN
Result<std::unique_ptr<Engine>> make_vulkan_engine(std::string_view wanted, int threads) {
  DUO_TRY_ASSIGN(const auto instance, vk::Instance::open(vk::Validation::kOff));
  DUO_TRY_ASSIGN(const auto devices, instance->devices());
  DUO_TRY_ASSIGN(const vk::PhysicalDevice chosen, vk::choose_device(devices, wanted));
  DUO_TRY_ASSIGN(auto device, vk::Device::make(instance, chosen));
  return make_vulkan_engine(std::move(device), threads);
}

bool may_have_card() { return vk::has_card(); }
#else
Result<std::unique_ptr<Engine>> make_vulkan_engine(std::string_view, int) {
  return Error{ErrorCode::kUnsupported,
               "make the engine: this build has no Vulkan: build with -DDUO_VULKAN=ON, or choose one of: auto, simd, ref"};
}

bool may_have_card() { return false; }
#endif

}  // namespace duo
