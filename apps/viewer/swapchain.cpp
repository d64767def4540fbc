#include "swapchain.h"

#include <fmt/format.h>

#include <algorithm>

namespace duo::app::view {

Result<std::unique_ptr<Swapchain>> Swapchain::open(const Gpu& gpu) {
  std::unique_ptr<Swapchain> out(new Swapchain(gpu));
  DUO_TRY(out->choose_format());
  DUO_TRY(out->make_pass());
  return out;
}

Swapchain::~Swapchain() {
  destroy_targets();
  vkDestroySwapchainKHR(gpu_.device, handle_, nullptr);
  vkDestroyRenderPass(gpu_.device, pass_, nullptr);
}

Result<void> Swapchain::choose_format() {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceSurfaceFormatsKHR(gpu_.physical, gpu_.surface, &count, nullptr);
  std::vector<VkSurfaceFormatKHR> formats(count);
  vkGetPhysicalDeviceSurfaceFormatsKHR(gpu_.physical, gpu_.surface, &count, formats.data());
  // Bytes as they are: ImGui's colours and our pictures are both in the display's own gamma.
  const auto found = std::find_if(formats.begin(), formats.end(), [](const VkSurfaceFormatKHR& f) {
    return f.format == VK_FORMAT_B8G8R8A8_UNORM || f.format == VK_FORMAT_R8G8B8A8_UNORM;
  });
  if (found == formats.end())
    return Error{ErrorCode::kUnsupported, fmt::format("cannot open a window: {} has no 8-bit format to show", gpu_.name)};
  format_ = *found;
  return {};
}

Result<void> Swapchain::make_pass() {
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
  return check(vkCreateRenderPass(gpu_.device, &info, nullptr, &pass_));
}

void Swapchain::destroy_targets() {
  for (const Target& target : targets_) {
    vkDestroyFramebuffer(gpu_.device, target.framebuffer, nullptr);
    vkDestroyImageView(gpu_.device, target.view, nullptr);
    vkDestroySemaphore(gpu_.device, target.drawn, nullptr);
  }
  targets_.clear();
}

Result<void> Swapchain::make(Size window) {
  DUO_TRY(check(vkDeviceWaitIdle(gpu_.device)));
  destroy_targets();
  VkSurfaceCapabilitiesKHR can;
  DUO_TRY(check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(gpu_.physical, gpu_.surface, &can)));
  extent_ = can.currentExtent;
  if (extent_.width == UINT32_MAX)  // Wayland: the window takes the size of what it is given
    extent_ = {std::clamp(static_cast<std::uint32_t>(window.width), can.minImageExtent.width, can.maxImageExtent.width),
               std::clamp(static_cast<std::uint32_t>(window.height), can.minImageExtent.height, can.maxImageExtent.height)};
  readable_ = (can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_SRC_BIT) != 0;
  VkSwapchainCreateInfoKHR info = {};
  info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
  info.surface = gpu_.surface;
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
  info.oldSwapchain = handle_;
  VkSwapchainKHR made = VK_NULL_HANDLE;
  const VkResult result = vkCreateSwapchainKHR(gpu_.device, &info, nullptr, &made);
  vkDestroySwapchainKHR(gpu_.device, handle_, nullptr);
  handle_ = made;
  DUO_TRY(check(result));

  std::uint32_t count = 0;
  DUO_TRY(check(vkGetSwapchainImagesKHR(gpu_.device, handle_, &count, nullptr)));
  std::vector<VkImage> images(count);
  DUO_TRY(check(vkGetSwapchainImagesKHR(gpu_.device, handle_, &count, images.data())));
  for (const VkImage image : images) DUO_TRY(make_target(image));
  stale_ = false;
  return {};
}

Result<void> Swapchain::make_target(VkImage image) {
  Target& target = targets_.emplace_back();
  target.image = image;
  VkImageViewCreateInfo view = {};
  view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  view.image = image;
  view.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view.format = format_.format;
  view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  DUO_TRY(check(vkCreateImageView(gpu_.device, &view, nullptr, &target.view)));
  VkFramebufferCreateInfo framebuffer = {};
  framebuffer.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
  framebuffer.renderPass = pass_;
  framebuffer.attachmentCount = 1;
  framebuffer.pAttachments = &target.view;
  framebuffer.width = extent_.width;
  framebuffer.height = extent_.height;
  framebuffer.layers = 1;
  DUO_TRY(check(vkCreateFramebuffer(gpu_.device, &framebuffer, nullptr, &target.framebuffer)));
  VkSemaphoreCreateInfo semaphore = {};
  semaphore.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
  return check(vkCreateSemaphore(gpu_.device, &semaphore, nullptr, &target.drawn));
}

Result<std::optional<std::uint32_t>> Swapchain::acquire(Size window, VkSemaphore acquired) {
  constexpr std::uint64_t kLongest_ns = 1'000'000'000;
  if (window != Size{static_cast<int>(extent_.width), static_cast<int>(extent_.height)}) stale_ = true;
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (stale_) DUO_TRY(make(window));
    std::uint32_t index = 0;
    const VkResult result = vkAcquireNextImageKHR(gpu_.device, handle_, kLongest_ns, acquired, VK_NULL_HANDLE, &index);
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

Result<void> Swapchain::show(std::uint32_t index) {
  VkPresentInfoKHR present = {};
  present.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
  present.waitSemaphoreCount = present.swapchainCount = 1;
  present.pWaitSemaphores = &targets_[index].drawn;
  present.pSwapchains = &handle_;
  present.pImageIndices = &index;
  const VkResult result = vkQueuePresentKHR(gpu_.queue, &present);
  if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) {
    stale_ = true;
    return {};
  }
  return check(result);
}

}  // namespace duo::app::view
