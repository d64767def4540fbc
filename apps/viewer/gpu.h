// The Vulkan device that draws the window, and the little that is made with it.
#pragma once

#include <vulkan/vulkan.h>

#include <memory>
#include <string>

#include "duoptic/image.h"
#include "duoptic/result.h"

struct GLFWwindow;

namespace duo::app::view {

/// "draw the window: out of device memory; ..." for anything but success.
Result<void> check(VkResult result);

/// Instance, surface, device and queue; ends after all that was made with it.
class Gpu {
 public:
  /// Errors  no Vulkan driver; no device that can draw into this window
  static Result<std::unique_ptr<Gpu>> open(GLFWwindow* window);
  ~Gpu();
  Gpu(const Gpu&) = delete;
  Gpu& operator=(const Gpu&) = delete;

  Result<VkDeviceMemory> allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags properties) const;

  VkInstance instance = VK_NULL_HANDLE;
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  std::uint32_t queue_family = 0;
  VkQueue queue = VK_NULL_HANDLE;
  std::string name;

 private:
  Gpu() = default;
  Result<void> create_instance();
  Result<void> choose_device();
  Result<void> create_device();
};

/// Memory that both sides see.
class HostBuffer {
 public:
  static Result<HostBuffer> make(const Gpu& gpu, VkDeviceSize bytes, VkBufferUsageFlags usage);
  HostBuffer() = default;
  HostBuffer(HostBuffer&& other) noexcept;
  HostBuffer& operator=(HostBuffer&& other) noexcept;
  ~HostBuffer();

  VkBuffer handle() const { return buffer_; }
  std::uint8_t* data() const { return data_; }

 private:
  const Gpu* gpu_ = nullptr;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  std::uint8_t* data_ = nullptr;
};

/// Records that an image is used in another way from here on.
struct Use {
  VkImageLayout layout;
  VkPipelineStageFlags stage;
  VkAccessFlags access;
};
void change_use(VkCommandBuffer commands, VkImage image, const Use& from, const Use& to);

}  // namespace duo::app::view
