// The pictures of a window that are drawn and shown in turn.
#pragma once

#include <optional>
#include <vector>

#include "gpu.h"

namespace duo::app::view {

/// Threads  the window's
class Swapchain {
 public:
  struct Target {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    VkSemaphore drawn = VK_NULL_HANDLE;  // to be signalled before it is shown
  };

  /// Errors  no 8-bit format; those of the driver
  static Result<std::unique_ptr<Swapchain>> open(const Gpu& gpu);
  ~Swapchain();
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  VkRenderPass pass() const { return pass_; }
  VkExtent2D extent() const { return extent_; }
  const Target& target(std::uint32_t index) const { return targets_[index]; }
  bool blue_first() const { return format_.format == VK_FORMAT_B8G8R8A8_UNORM; }
  bool readable() const { return readable_; }  // its pictures can be copied

  /// Which picture to draw into, once `acquired` is signalled; none when the window cannot show one now. Made anew when the
  /// window has another size, which must not be empty; nothing may be in flight then.
  Result<std::optional<std::uint32_t>> acquire(Size window, VkSemaphore acquired);
  Result<void> show(std::uint32_t index);

 private:
  explicit Swapchain(const Gpu& gpu) : gpu_(gpu) {}
  Result<void> choose_format();
  Result<void> make_pass();
  Result<void> make(Size window);
  Result<void> make_target(VkImage image);
  void destroy_targets();

  const Gpu& gpu_;
  VkSurfaceFormatKHR format_ = {};
  VkRenderPass pass_ = VK_NULL_HANDLE;
  VkSwapchainKHR handle_ = VK_NULL_HANDLE;
  VkExtent2D extent_ = {};
  std::vector<Target> targets_;
  bool stale_ = true, readable_ = false;  // stale: it no longer fits the window
};

}  // namespace duo::app::view
