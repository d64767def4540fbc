// A window that ImGui draws into.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu.h"
#include "textures.h"

struct GLFWwindow;

namespace duo::app::view {

/// GLFW's window, Vulkan's swapchain and ImGui's context, one of each in a process.
///
/// Threads  the main thread's; wake() is anyone's
class Window {
 public:
  /// Errors  no display, no Vulkan driver, no device that can draw into the window
  static Result<std::unique_ptr<Window>> open(const std::string& title, Size size);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Until something happens, or the time is over.
  static void wait(double seconds);
  static void wake();

  bool closing() const;
  /// What was pressed since the last call, as GLFW_KEY_*; without those that ImGui's text fields take.
  std::vector<int> keys();
  void set_title(const std::string& title);
  /// How much larger than 96 dots per inch letters and lines shall be.
  float scale() const { return scale_; }
  const std::string& device() const { return gpu_->name; }
  Textures& textures() { return *textures_; }

  /// Starts ImGui's frame; false while there is nothing to draw on (minimised).
  ///
  /// Errors  the graphics card was lost, or is out of memory
  Result<bool> begin();
  /// Shows what ImGui was told since begin().
  Result<void> end();
  /// The next end() keeps what it shows; then screenshot() has it once.
  void want_screenshot() { wanted_ = true; }
  std::optional<Image<Rgb8>> screenshot() { return std::exchange(screenshot_, std::nullopt); }

 private:
  struct Target {
    VkImageView view = VK_NULL_HANDLE;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    VkSemaphore drawn = VK_NULL_HANDLE;
    VkImage image = VK_NULL_HANDLE;
  };
  Window() = default;
  Result<void> create_glfw(const std::string& title, Size size);
  Result<void> create_pass();
  Result<void> create_commands();
  Result<void> create_imgui();
  Result<void> make_swapchain();
  Result<void> make_target(VkImage image);
  void destroy_targets();
  Result<std::optional<std::uint32_t>> acquire();
  Result<void> record(const Target& target, const HostBuffer* keep);
  Result<void> show(std::uint32_t index);
  Size framebuffer_size() const;

  bool glfw_ = false, imgui_ = false;
  GLFWwindow* window_ = nullptr;
  float scale_ = 1;
  std::string title_;
  std::vector<int> keys_;
  std::unique_ptr<Gpu> gpu_;
  VkSurfaceFormatKHR format_ = {};
  VkRenderPass pass_ = VK_NULL_HANDLE;
  VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  VkFence done_ = VK_NULL_HANDLE;
  VkSemaphore acquired_ = VK_NULL_HANDLE;
  VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
  VkExtent2D extent_ = {};
  std::vector<Target> targets_;
  bool stale_ = true, readable_ = false;  // the swapchain no longer fits; its pictures can be copied
  bool wanted_ = false;
  std::optional<Image<Rgb8>> screenshot_;
  std::unique_ptr<Textures> textures_;
};

}  // namespace duo::app::view
