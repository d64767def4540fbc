#include "window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui/backends/imgui_impl_glfw.h>
#include <imgui/backends/imgui_impl_vulkan.h>

#include <algorithm>
#include <cstdlib>

namespace duo::app::view {
namespace {

constexpr std::uint64_t kLongest_ns = 5'000'000'000;

/// What GLFW said last; it speaks through a call-back.
std::string& glfw_words() {
  static std::string words;
  return words;
}

Error no_window() {
  const bool display = std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
  std::string words = glfw_words();
  std::replace(words.begin(), words.end(), '\n', ' ');
  return {
      ErrorCode::kUnsupported,
      fmt::format("cannot open a window: {}{}; without a display use duoptic track, or run under xvfb-run",
                  display ? "" : "there is no display (DISPLAY is not set): ", words.empty() ? "GLFW gives no reason" : words)};
}

}  // namespace

Result<std::unique_ptr<Window>> Window::open(const std::string& title, Size size) {
  std::unique_ptr<Window> out(new Window);
  DUO_TRY(out->create_glfw(title, size));
  DUO_TRY_ASSIGN(out->gpu_, Gpu::open(out->window_));
  DUO_TRY_ASSIGN(out->swapchain_, Swapchain::open(*out->gpu_));
  DUO_TRY(out->create_commands());
  DUO_TRY(out->create_imgui());
  DUO_TRY_ASSIGN(out->textures_, Textures::open(*out->gpu_, out->descriptors_, out->swapchain_->pass()));
  return out;
}

Window::~Window() {
  if (gpu_) {
    vkDeviceWaitIdle(gpu_->device);
    if (imgui_) ImGui_ImplVulkan_Shutdown();
    textures_.reset();
    swapchain_.reset();
    vkDestroySemaphore(gpu_->device, acquired_, nullptr);
    vkDestroyFence(gpu_->device, done_, nullptr);
    vkDestroyCommandPool(gpu_->device, pool_, nullptr);
    vkDestroyDescriptorPool(gpu_->device, descriptors_, nullptr);
    if (imgui_) ImGui_ImplGlfw_Shutdown();
    gpu_.reset();
  }
  if (ImGui::GetCurrentContext() != nullptr) ImGui::DestroyContext();
  if (window_ != nullptr) glfwDestroyWindow(window_);
  if (glfw_) glfwTerminate();
}

void Window::wait(double seconds) { glfwWaitEventsTimeout(seconds); }
void Window::wake() { glfwPostEmptyEvent(); }
bool Window::closing() const { return glfwWindowShouldClose(window_) != GLFW_FALSE; }

std::vector<int> Window::keys() {
  std::vector<int> out = std::exchange(keys_, {});
  if (ImGui::GetIO().WantTextInput) out.clear();
  return out;
}

void Window::set_title(const std::string& title) {
  if (title == title_) return;
  title_ = title;
  glfwSetWindowTitle(window_, title.c_str());
}

Result<void> Window::create_glfw(const std::string& title, Size size) {
  glfw_words().clear();
  glfwSetErrorCallback([](int, const char* words) { glfw_words() = words; });
  glfw_ = glfwInit() == GLFW_TRUE;
  if (!glfw_) return no_window();
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  title_ = title;
  window_ = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
  if (window_ == nullptr) return no_window();
  // ImGui 1.86 loses a key that is pressed and released between two frames; it passes on what it hears.
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int) {
    if (action == GLFW_PRESS) static_cast<Window*>(glfwGetWindowUserPointer(window))->keys_.push_back(key);
  });
  glfwSetWindowSizeLimits(window_, 640, 420, GLFW_DONT_CARE, GLFW_DONT_CARE);
  float across = 1, down = 1;
  glfwGetWindowContentScale(window_, &across, &down);
  scale_ = std::clamp(across, 1.0f, 4.0f);
  return {};
}

Result<void> Window::create_commands() {
  constexpr std::uint32_t kTextures = 16;
  const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kTextures};
  VkDescriptorPoolCreateInfo descriptors = {};
  descriptors.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  descriptors.maxSets = kTextures;
  descriptors.poolSizeCount = 1;
  descriptors.pPoolSizes = &size;
  DUO_TRY(check(vkCreateDescriptorPool(gpu_->device, &descriptors, nullptr, &descriptors_)));

  VkCommandPoolCreateInfo pool = {};
  pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
  pool.queueFamilyIndex = gpu_->queue_family;
  DUO_TRY(check(vkCreateCommandPool(gpu_->device, &pool, nullptr, &pool_)));
  VkCommandBufferAllocateInfo allocate = {};
  allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  allocate.commandPool = pool_;
  allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  allocate.commandBufferCount = 1;
  DUO_TRY(check(vkAllocateCommandBuffers(gpu_->device, &allocate, &commands_)));
  VkFenceCreateInfo fence = {};
  fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
  fence.flags = VK_FENCE_CREATE_SIGNALED_BIT;
  DUO_TRY(check(vkCreateFence(gpu_->device, &fence, nullptr, &done_)));
  VkSemaphoreCreateInfo semaphore = {};
  semaphore.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
  return check(vkCreateSemaphore(gpu_->device, &semaphore, nullptr, &acquired_));
}

Result<void> Window::create_imgui() {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // the layout is fixed, and no file is left behind
  ImGui::GetIO().LogFilename = nullptr;
  ImGui_ImplGlfw_InitForVulkan(window_, true);
  ImGui_ImplVulkan_InitInfo info = {};
  info.Instance = gpu_->instance;
  info.PhysicalDevice = gpu_->physical;
  info.Device = gpu_->device;
  info.QueueFamily = gpu_->queue_family;
  info.Queue = gpu_->queue;
  info.DescriptorPool = descriptors_;
  info.MinImageCount = info.ImageCount = 2;  // of its vertex buffers; one frame is in flight
  ImGui_ImplVulkan_Init(&info, swapchain_->pass());
  imgui_ = true;
  return {};
}

Size Window::framebuffer_size() const {
  Size size;
  glfwGetFramebufferSize(window_, &size.width, &size.height);
  return size;
}

/// The letters' picture goes to the card once, by itself.
Result<void> Window::upload_letters() {
  VkCommandBufferBeginInfo once = {};
  once.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  once.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  DUO_TRY(check(vkBeginCommandBuffer(commands_, &once)));
  ImGui_ImplVulkan_CreateFontsTexture(commands_);
  DUO_TRY(check(vkEndCommandBuffer(commands_)));
  VkSubmitInfo submit = {};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands_;
  DUO_TRY(check(vkQueueSubmit(gpu_->queue, 1, &submit, VK_NULL_HANDLE)));
  DUO_TRY(check(vkQueueWaitIdle(gpu_->queue)));
  ImGui_ImplVulkan_DestroyFontUploadObjects();
  letters_ = true;
  return {};
}

Result<bool> Window::begin() {
  const Size size = framebuffer_size();
  if (size.empty() || glfwGetWindowAttrib(window_, GLFW_ICONIFIED) != GLFW_FALSE) return false;
  DUO_TRY(check(vkWaitForFences(gpu_->device, 1, &done_, VK_TRUE, kLongest_ns)));
  if (!letters_) DUO_TRY(upload_letters());
  textures_->forget_frame();
  ImGui_ImplVulkan_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  return true;
}

Result<void> Window::end() {
  ImGui::Render();
  const Size window = framebuffer_size();
  if (window.empty()) return {};
  DUO_TRY_ASSIGN(const auto index, swapchain_->acquire(window, acquired_));
  if (!index) return {};
  const VkExtent2D extent = swapchain_->extent();
  const bool keep = std::exchange(wanted_, false) && swapchain_->readable();
  HostBuffer pixels;
  if (keep) {
    DUO_TRY_ASSIGN(pixels,
                   HostBuffer::make(*gpu_, VkDeviceSize{4} * extent.width * extent.height, VK_BUFFER_USAGE_TRANSFER_DST_BIT));
  }
  const Swapchain::Target& target = swapchain_->target(*index);
  DUO_TRY(record(target, keep ? &pixels : nullptr));
  DUO_TRY(submit(target));
  DUO_TRY(swapchain_->show(*index));
  if (!keep) return {};
  DUO_TRY(check(vkWaitForFences(gpu_->device, 1, &done_, VK_TRUE, kLongest_ns)));
  Image<Rgb8> copy({static_cast<int>(extent.width), static_cast<int>(extent.height)});
  const int red = swapchain_->blue_first() ? 2 : 0;
  const std::uint8_t* p = pixels.data();
  for (int y = 0; y < copy.height(); ++y)
    for (int x = 0; x < copy.width(); ++x, p += 4) copy.at(y, x) = {p[red], p[1], p[2 - red]};
  screenshot_ = std::move(copy);
  return {};
}

Result<void> Window::record(const Swapchain::Target& target, const HostBuffer* keep) {
  VkCommandBufferBeginInfo once = {};
  once.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  once.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  DUO_TRY(check(vkBeginCommandBuffer(commands_, &once)));
  textures_->upload(commands_);
  const VkClearValue clear = {};
  VkRenderPassBeginInfo pass = {};
  pass.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
  pass.renderPass = swapchain_->pass();
  pass.framebuffer = target.framebuffer;
  pass.renderArea.extent = swapchain_->extent();
  pass.clearValueCount = 1;
  pass.pClearValues = &clear;
  vkCmdBeginRenderPass(commands_, &pass, VK_SUBPASS_CONTENTS_INLINE);
  ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands_);
  vkCmdEndRenderPass(commands_);
  if (keep != nullptr) {
    const Use shown = {VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                       VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT},
              read = {VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT},
              after = {VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, 0};
    change_use(commands_, target.image, shown, read);
    VkBufferImageCopy copy = {};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {swapchain_->extent().width, swapchain_->extent().height, 1};
    vkCmdCopyImageToBuffer(commands_, target.image, read.layout, keep->handle(), 1, &copy);
    change_use(commands_, target.image, read, after);
  }
  return check(vkEndCommandBuffer(commands_));
}

Result<void> Window::submit(const Swapchain::Target& target) {
  DUO_TRY(check(vkResetFences(gpu_->device, 1, &done_)));
  const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
  VkSubmitInfo submit = {};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submit.waitSemaphoreCount = submit.signalSemaphoreCount = submit.commandBufferCount = 1;
  submit.pWaitSemaphores = &acquired_;
  submit.pWaitDstStageMask = &stage;
  submit.pCommandBuffers = &commands_;
  submit.pSignalSemaphores = &target.drawn;
  return check(vkQueueSubmit(gpu_->queue, 1, &submit, done_));
}

}  // namespace duo::app::view
