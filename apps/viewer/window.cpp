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
  DUO_TRY(out->create_pass());
  DUO_TRY(out->create_commands());
  DUO_TRY(out->create_imgui());
  DUO_TRY_ASSIGN(out->textures_, Textures::open(*out->gpu_, out->descriptors_, out->pass_));
  return out;
}

Window::~Window() {
  if (gpu_) {
    vkDeviceWaitIdle(gpu_->device);
    if (imgui_) ImGui_ImplVulkan_Shutdown();
    textures_.reset();
    destroy_targets();
    vkDestroySwapchainKHR(gpu_->device, swapchain_, nullptr);
    vkDestroySemaphore(gpu_->device, acquired_, nullptr);
    vkDestroyFence(gpu_->device, done_, nullptr);
    vkDestroyCommandPool(gpu_->device, pool_, nullptr);
    vkDestroyDescriptorPool(gpu_->device, descriptors_, nullptr);
    vkDestroyRenderPass(gpu_->device, pass_, nullptr);
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

Result<void> Window::create_pass() {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceSurfaceFormatsKHR(gpu_->physical, gpu_->surface, &count, nullptr);
  std::vector<VkSurfaceFormatKHR> formats(count);
  vkGetPhysicalDeviceSurfaceFormatsKHR(gpu_->physical, gpu_->surface, &count, formats.data());
  // Bytes as they are: ImGui's colours and our pictures are both in the display's own gamma.
  const auto found = std::find_if(formats.begin(), formats.end(), [](const VkSurfaceFormatKHR& f) {
    return f.format == VK_FORMAT_B8G8R8A8_UNORM || f.format == VK_FORMAT_R8G8B8A8_UNORM;
  });
  if (found == formats.end())
    return Error{ErrorCode::kUnsupported, fmt::format("cannot open a window: {} has no 8-bit format to show", gpu_->name)};
  format_ = *found;

  VkAttachmentDescription color = {};
  color.format = format_.format;
  color.samples = VK_SAMPLE_COUNT_1_BIT;
  color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  color.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  color.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  color.finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
  const VkAttachmentReference reference = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  VkSubpassDescription subpass = {};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &reference;
  VkSubpassDependency after_acquire = {};
  after_acquire.srcSubpass = VK_SUBPASS_EXTERNAL;
  after_acquire.srcStageMask = after_acquire.dstStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
  after_acquire.dstAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
  VkRenderPassCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
  info.attachmentCount = 1;
  info.pAttachments = &color;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  info.dependencyCount = 1;
  info.pDependencies = &after_acquire;
  return check(vkCreateRenderPass(gpu_->device, &info, nullptr, &pass_));
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
  ImGui_ImplVulkan_Init(&info, pass_);
  imgui_ = true;
  return {};
}

Size Window::framebuffer_size() const {
  Size size;
  glfwGetFramebufferSize(window_, &size.width, &size.height);
  return size;
}

void Window::destroy_targets() {
  for (const Target& target : targets_) {
    vkDestroyFramebuffer(gpu_->device, target.framebuffer, nullptr);
    vkDestroyImageView(gpu_->device, target.view, nullptr);
    vkDestroySemaphore(gpu_->device, target.drawn, nullptr);
  }
  targets_.clear();
}

Result<void> Window::make_swapchain() {
  DUO_TRY(check(vkDeviceWaitIdle(gpu_->device)));
  destroy_targets();
  VkSurfaceCapabilitiesKHR can;
  DUO_TRY(check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(gpu_->physical, gpu_->surface, &can)));
  const Size size = framebuffer_size();
  extent_ = can.currentExtent;
  if (extent_.width == UINT32_MAX)  // Wayland: the window takes the size of what it is given
    extent_ = {std::clamp(static_cast<std::uint32_t>(size.width), can.minImageExtent.width, can.maxImageExtent.width),
               std::clamp(static_cast<std::uint32_t>(size.height), can.minImageExtent.height, can.maxImageExtent.height)};
  readable_ = (can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_SRC_BIT) != 0;
  VkSwapchainCreateInfoKHR info = {};
  info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
  info.surface = gpu_->surface;
  info.minImageCount = can.minImageCount + 1;
  if (can.maxImageCount > 0) info.minImageCount = std::min(info.minImageCount, can.maxImageCount);
  info.imageFormat = format_.format;
  info.imageColorSpace = format_.colorSpace;
  info.imageExtent = extent_;
  info.imageArrayLayers = 1;
  info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  if (readable_) info.imageUsage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  info.preTransform = can.currentTransform;
  info.compositeAlpha = (can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) != 0
                            ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                            : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
  info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
  info.clipped = VK_TRUE;
  info.oldSwapchain = swapchain_;
  VkSwapchainKHR made = VK_NULL_HANDLE;
  const VkResult result = vkCreateSwapchainKHR(gpu_->device, &info, nullptr, &made);
  vkDestroySwapchainKHR(gpu_->device, swapchain_, nullptr);
  swapchain_ = made;
  DUO_TRY(check(result));

  std::uint32_t count = 0;
  DUO_TRY(check(vkGetSwapchainImagesKHR(gpu_->device, swapchain_, &count, nullptr)));
  std::vector<VkImage> images(count);
  DUO_TRY(check(vkGetSwapchainImagesKHR(gpu_->device, swapchain_, &count, images.data())));
  for (const VkImage image : images) DUO_TRY(make_target(image));
  stale_ = false;
  return {};
}

Result<void> Window::make_target(VkImage image) {
  Target& target = targets_.emplace_back();
  target.image = image;
  VkImageViewCreateInfo view = {};
  view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  view.image = image;
  view.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view.format = format_.format;
  view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  DUO_TRY(check(vkCreateImageView(gpu_->device, &view, nullptr, &target.view)));
  VkFramebufferCreateInfo framebuffer = {};
  framebuffer.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
  framebuffer.renderPass = pass_;
  framebuffer.attachmentCount = 1;
  framebuffer.pAttachments = &target.view;
  framebuffer.width = extent_.width;
  framebuffer.height = extent_.height;
  framebuffer.layers = 1;
  DUO_TRY(check(vkCreateFramebuffer(gpu_->device, &framebuffer, nullptr, &target.framebuffer)));
  VkSemaphoreCreateInfo semaphore = {};
  semaphore.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
  return check(vkCreateSemaphore(gpu_->device, &semaphore, nullptr, &target.drawn));
}

Result<bool> Window::begin() {
  const Size size = framebuffer_size();
  if (size.empty() || glfwGetWindowAttrib(window_, GLFW_ICONIFIED) != GLFW_FALSE) return false;
  DUO_TRY(check(vkWaitForFences(gpu_->device, 1, &done_, VK_TRUE, kLongest_ns)));
  if (!ImGui::GetIO().Fonts->IsBuilt() || ImGui::GetIO().Fonts->TexID == nullptr) {
    // The letters' picture goes to the card once, by itself.
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
  }
  if (size != Size{static_cast<int>(extent_.width), static_cast<int>(extent_.height)}) stale_ = true;
  textures_->forget_frame();
  ImGui_ImplVulkan_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  return true;
}

/// Which picture to draw into; none when the window cannot show one now.
Result<std::optional<std::uint32_t>> Window::acquire() {
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (stale_) {
      if (framebuffer_size().empty()) break;
      DUO_TRY(make_swapchain());
    }
    std::uint32_t index = 0;
    const VkResult result = vkAcquireNextImageKHR(gpu_->device, swapchain_, kLongest_ns / 5, acquired_, VK_NULL_HANDLE, &index);
    if (result == VK_SUCCESS || result == VK_SUBOPTIMAL_KHR) {
      stale_ = result == VK_SUBOPTIMAL_KHR;
      return std::optional(index);
    }
    if (result == VK_TIMEOUT || result == VK_NOT_READY) break;  // hidden windows are not served everywhere
    if (result != VK_ERROR_OUT_OF_DATE_KHR) return check(result).error();
    stale_ = true;
  }
  return std::optional<std::uint32_t>();
}

Result<void> Window::end() {
  ImGui::Render();
  DUO_TRY_ASSIGN(const auto index, acquire());
  if (!index) return {};
  const bool keep = std::exchange(wanted_, false) && readable_;
  HostBuffer pixels;
  if (keep) {
    DUO_TRY_ASSIGN(pixels,
                   HostBuffer::make(*gpu_, VkDeviceSize{4} * extent_.width * extent_.height, VK_BUFFER_USAGE_TRANSFER_DST_BIT));
  }
  const VkExtent2D extent = extent_;
  DUO_TRY(record(targets_[*index], keep ? &pixels : nullptr));
  DUO_TRY(show(*index));
  if (!keep) return {};
  DUO_TRY(check(vkWaitForFences(gpu_->device, 1, &done_, VK_TRUE, kLongest_ns)));
  Image<Rgb8> copy({static_cast<int>(extent.width), static_cast<int>(extent.height)});
  const bool blue_first = format_.format == VK_FORMAT_B8G8R8A8_UNORM;
  const std::uint8_t* p = pixels.data();
  for (int y = 0; y < copy.height(); ++y)
    for (int x = 0; x < copy.width(); ++x, p += 4) copy.at(y, x) = {p[blue_first ? 2 : 0], p[1], p[blue_first ? 0 : 2]};
  screenshot_ = std::move(copy);
  return {};
}

Result<void> Window::record(const Target& target, const HostBuffer* keep) {
  VkCommandBufferBeginInfo once = {};
  once.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  once.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  DUO_TRY(check(vkBeginCommandBuffer(commands_, &once)));
  textures_->upload(commands_);
  const VkClearValue clear = {};
  VkRenderPassBeginInfo pass = {};
  pass.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
  pass.renderPass = pass_;
  pass.framebuffer = target.framebuffer;
  pass.renderArea.extent = extent_;
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
    copy.imageExtent = {extent_.width, extent_.height, 1};
    vkCmdCopyImageToBuffer(commands_, target.image, read.layout, keep->handle(), 1, &copy);
    change_use(commands_, target.image, read, after);
  }
  return check(vkEndCommandBuffer(commands_));
}

Result<void> Window::show(std::uint32_t index) {
  DUO_TRY(check(vkResetFences(gpu_->device, 1, &done_)));
  const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
  VkSubmitInfo submit = {};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submit.waitSemaphoreCount = submit.signalSemaphoreCount = submit.commandBufferCount = 1;
  submit.pWaitSemaphores = &acquired_;
  submit.pWaitDstStageMask = &stage;
  submit.pCommandBuffers = &commands_;
  submit.pSignalSemaphores = &targets_[index].drawn;
  DUO_TRY(check(vkQueueSubmit(gpu_->queue, 1, &submit, done_)));
  VkPresentInfoKHR present = {};
  present.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
  present.waitSemaphoreCount = present.swapchainCount = 1;
  present.pWaitSemaphores = &targets_[index].drawn;
  present.pSwapchains = &swapchain_;
  present.pImageIndices = &index;
  const VkResult result = vkQueuePresentKHR(gpu_->queue, &present);
  if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) {
    stale_ = true;
    return {};
  }
  return check(result);
}

}  // namespace duo::app::view
