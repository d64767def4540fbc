// Owned: a Vulkan object that is destroyed with its owner; leaked where a hung device may still use it.
#pragma once

#include <string>
#include <utility>

#include "vulkan/device.h"

namespace duo::vk {

/// Move-only; `Create` and `Destroy` are the members of DeviceFunctions that make and destroy it.
template <class Handle, auto Create, auto Destroy>
class Owned {
 public:
  Owned() = default;
  Owned(const Device& device, Handle handle) : device_(&device), handle_(handle) {}
  /// Errors  what the driver answers; `tried` starts the line
  template <class Info>
  static Result<Owned> make(const Device& device, const Info& info, const std::string& tried) {
    Handle handle = VK_NULL_HANDLE;
    if (const VkResult r = (device.fn().*Create)(device.handle(), &info, nullptr, &handle); r != VK_SUCCESS)
      return device.error(tried, r);
    return Owned(device, handle);
  }
  Owned(Owned&& other) noexcept : device_(other.device_), handle_(std::exchange(other.handle_, VK_NULL_HANDLE)) {}
  Owned& operator=(Owned&& other) noexcept {
    Owned moved(std::move(other));
    std::swap(device_, moved.device_);
    std::swap(handle_, moved.handle_);
    return *this;
  }
  ~Owned() {
    if (handle_ != VK_NULL_HANDLE && !device_->hung()) (device_->fn().*Destroy)(device_->handle(), handle_, nullptr);
  }
  Handle get() const { return handle_; }

 private:
  const Device* device_ = nullptr;
  Handle handle_ = VK_NULL_HANDLE;
};

using OwnedBuffer = Owned<VkBuffer, &DeviceFunctions::vkCreateBuffer, &DeviceFunctions::vkDestroyBuffer>;
using OwnedMemory = Owned<VkDeviceMemory, &DeviceFunctions::vkAllocateMemory, &DeviceFunctions::vkFreeMemory>;
using OwnedShader = Owned<VkShaderModule, &DeviceFunctions::vkCreateShaderModule, &DeviceFunctions::vkDestroyShaderModule>;
using OwnedSetLayout =
    Owned<VkDescriptorSetLayout, &DeviceFunctions::vkCreateDescriptorSetLayout, &DeviceFunctions::vkDestroyDescriptorSetLayout>;
using OwnedLayout =
    Owned<VkPipelineLayout, &DeviceFunctions::vkCreatePipelineLayout, &DeviceFunctions::vkDestroyPipelineLayout>;
using OwnedSetPool =
    Owned<VkDescriptorPool, &DeviceFunctions::vkCreateDescriptorPool, &DeviceFunctions::vkDestroyDescriptorPool>;
using OwnedCommandPool = Owned<VkCommandPool, &DeviceFunctions::vkCreateCommandPool, &DeviceFunctions::vkDestroyCommandPool>;
// Pipelines are made several at a time, by a function of another form.
using OwnedPipeline = Owned<VkPipeline, nullptr, &DeviceFunctions::vkDestroyPipeline>;
using OwnedQueries = Owned<VkQueryPool, &DeviceFunctions::vkCreateQueryPool, &DeviceFunctions::vkDestroyQueryPool>;

}  // namespace duo::vk
