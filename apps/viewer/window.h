// A window that ImGui draws into.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gpu.h"
#include "swapchain.h"
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
  Window() = default;
  Result<void> create_glfw(const std::string& title, Size size);
  Result<void> create_commands();
  Result<void> create_imgui();
  Result<void> upload_letters();
  Result<void> record(const Swapchain::Target& target, const HostBuffer* keep);
  Result<void> submit(const Swapchain::Target& target);
  Size framebuffer_size() const;

  bool glfw_ = false, imgui_ = false, letters_ = false;  // what was started
  GLFWwindow* window_ = nullptr;
  float scale_ = 1;
  std::string title_;
  std::vector<int> keys_;
  std::unique_ptr<Gpu> gpu_;
  std::unique_ptr<Swapchain> swapchain_;
  VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  VkFence done_ = VK_NULL_HANDLE;
  VkSemaphore acquired_ = VK_NULL_HANDLE;
  bool wanted_ = false;
  std::optional<Image<Rgb8>> screenshot_;
  std::unique_ptr<Textures> textures_;
};

}  // namespace duo::app::view
