// Pictures on the graphics card, and drawing them between what ImGui draws.
#pragma once

#include <imgui/imgui.h>

#include <deque>
#include <memory>
#include <vector>

#include "gpu.h"

namespace duo::app::view {

/// A picture that may change every frame, and its size with it.
class Texture {
 public:
  Texture() = default;
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;
  ~Texture();
  Size size() const { return size_; }

 private:
  friend class Textures;
  const Gpu* gpu_ = nullptr;
  Size size_;
  HostBuffer staging_;
  VkImage image_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
  bool fresh_ = false, changed_ = false;  // never on the card; not yet with its newest pixels
};

/// The backend of ImGui 1.86 knows one texture, the font's: pictures are drawn by call-backs with a pipeline of their own.
///
/// Threads  the window's; set() and draw() between Window::begin() and Window::end()
class Textures {
 public:
  static Result<std::unique_ptr<Textures>> open(const Gpu& gpu, VkDescriptorPool pool, VkRenderPass pass);
  ~Textures();
  Textures(const Textures&) = delete;
  Textures& operator=(const Textures&) = delete;

  Result<void> set(Texture& texture, View<const Rgb8> pixels);
  /// Draws it between two corners, window coordinates; nothing before the first set().
  void draw(ImDrawList& list, const Texture& texture, ImVec2 from, ImVec2 to);

  /// Records the copies that set() asked for; call-backs of the frame then record into the same commands.
  void upload(VkCommandBuffer commands);
  void forget_frame() { quads_.clear(); }

 private:
  struct Quad {
    Textures* textures;
    VkDescriptorSet set;
    ImVec2 from, to;
  };
  explicit Textures(const Gpu& gpu) : gpu_(gpu) {}
  Result<void> create(VkDescriptorPool pool, VkRenderPass pass);
  Result<void> create_pipeline(VkRenderPass pass);
  Result<void> make_image(Texture& texture, Size size);
  static void draw_quad(const ImDrawList* list, const ImDrawCmd* command);

  const Gpu& gpu_;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  VkSampler sampler_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  std::deque<Quad> quads_;  // of the frame; call-backs point to them
  std::vector<Texture*> waiting_;
};

}  // namespace duo::app::view
