#include "gpu.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace duo::app::view {
namespace {

constexpr char kNoDriver[] =
    "cannot open a window: Vulkan has no driver here; install the graphics card's, or mesa-vulkan-drivers, whose software "
    "driver "
    "runs anywhere";

std::string words_of(VkResult result) {
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      return "out of memory; close other programs";
    case VK_ERROR_DEVICE_LOST:
      return "the graphics card was lost; start again";
    case VK_ERROR_SURFACE_LOST_KHR:
      return "the window was lost; start again";
    case VK_TIMEOUT:
      return "the graphics card did not answer for seconds; start again";
    default:
      return fmt::format("Vulkan error {}", static_cast<int>(result));
  }
}

bool has_extension(VkPhysicalDevice device, const char* name) {
  std::uint32_t count = 0;
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> all(count);
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, all.data());
  return std::any_of(all.begin(), all.end(), [&](const auto& e) { return std::string_view(e.extensionName) == name; });
}

/// The first family that draws and shows.
std::optional<std::uint32_t> queue_family_of(VkPhysicalDevice device, VkSurfaceKHR surface) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  for (std::uint32_t i = 0; i < count; ++i) {
    VkBool32 shows = VK_FALSE;
    vkGetPhysicalDeviceSurfaceSupportKHR(device, i, surface, &shows);
    if (shows && (families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0) return i;
  }
  return {};
}

int rank_of(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return 3;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return 4;  // it shares the display's memory, and a window asks for little
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return 2;
    default:
      return 1;
  }
}

}  // namespace

Result<void> check(VkResult result) {
  if (result == VK_SUCCESS) return {};
  return Error{ErrorCode::kDeviceLost, "cannot draw the window: " + words_of(result)};
}

Result<std::unique_ptr<Gpu>> Gpu::open(GLFWwindow* window) {
  if (glfwVulkanSupported() == GLFW_FALSE) return Error{ErrorCode::kUnsupported, kNoDriver};
  std::unique_ptr<Gpu> gpu(new Gpu);
  DUO_TRY(gpu->create_instance());
  DUO_TRY(check(glfwCreateWindowSurface(gpu->instance, window, nullptr, &gpu->surface)));
  DUO_TRY(gpu->choose_device());
  DUO_TRY(gpu->create_device());
  return gpu;
}

Gpu::~Gpu() {
  if (device != VK_NULL_HANDLE) vkDestroyDevice(device, nullptr);
  if (surface != VK_NULL_HANDLE) vkDestroySurfaceKHR(instance, surface, nullptr);
  if (instance != VK_NULL_HANDLE) vkDestroyInstance(instance, nullptr);
}

Result<void> Gpu::create_instance() {
  std::uint32_t count = 0;
  const char** extensions = glfwGetRequiredInstanceExtensions(&count);
  if (extensions == nullptr) return Error{ErrorCode::kUnsupported, kNoDriver};
  const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                         .pNext = nullptr,
                                         .pApplicationName = "duoptic",
                                         .applicationVersion = 0,
                                         .pEngineName = nullptr,
                                         .engineVersion = 0,
                                         .apiVersion = VK_API_VERSION_1_0};
  VkInstanceCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  info.pApplicationInfo = &application;
  info.enabledExtensionCount = count;
  info.ppEnabledExtensionNames = extensions;
  const VkResult result = vkCreateInstance(&info, nullptr, &instance);
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER) return Error{ErrorCode::kUnsupported, kNoDriver};
  return check(result);
}

Result<void> Gpu::choose_device() {
  std::uint32_t count = 0;
  vkEnumeratePhysicalDevices(instance, &count, nullptr);
  std::vector<VkPhysicalDevice> devices(count);
  vkEnumeratePhysicalDevices(instance, &count, devices.data());
  int best = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(devices[i], &properties);
    const auto family = queue_family_of(devices[i], surface);
    if (!family || !has_extension(devices[i], VK_KHR_SWAPCHAIN_EXTENSION_NAME) || rank_of(properties.deviceType) <= best)
      continue;
    best = rank_of(properties.deviceType);
    physical = devices[i];
    queue_family = *family;
    name = properties.deviceName;
  }
  if (physical != VK_NULL_HANDLE) return {};
  return Error{ErrorCode::kUnsupported, count == 0
                                            ? kNoDriver
                                            : "cannot open a window: none of this machine's Vulkan devices can draw into "
                                              "it (see duoptic version); install mesa-vulkan-drivers"};
}

Result<void> Gpu::create_device() {
  const float priority = 1;
  VkDeviceQueueCreateInfo queue_info = {};
  queue_info.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue_info.queueFamilyIndex = queue_family;
  queue_info.queueCount = 1;
  queue_info.pQueuePriorities = &priority;
  const char* extension = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
  VkDeviceCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue_info;
  info.enabledExtensionCount = 1;
  info.ppEnabledExtensionNames = &extension;
  DUO_TRY(check(vkCreateDevice(physical, &info, nullptr, &device)));
  vkGetDeviceQueue(device, queue_family, 0, &queue);
  return {};
}

Result<VkDeviceMemory> Gpu::allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags properties) const {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(physical, &memory);
  for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
    if ((needs.memoryTypeBits >> i & 1) == 0 || (memory.memoryTypes[i].propertyFlags & properties) != properties) continue;
    VkMemoryAllocateInfo info = {};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.allocationSize = needs.size;
    info.memoryTypeIndex = i;
    VkDeviceMemory out = VK_NULL_HANDLE;
    DUO_TRY(check(vkAllocateMemory(device, &info, nullptr, &out)));
    return out;
  }
  return check(VK_ERROR_OUT_OF_DEVICE_MEMORY).error();
}

Result<HostBuffer> HostBuffer::make(const Gpu& gpu, VkDeviceSize bytes, VkBufferUsageFlags usage) {
  HostBuffer out;
  out.gpu_ = &gpu;
  VkBufferCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = bytes;
  info.usage = usage;
  DUO_TRY(check(vkCreateBuffer(gpu.device, &info, nullptr, &out.buffer_)));
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(gpu.device, out.buffer_, &needs);
  DUO_TRY_ASSIGN(out.memory_, gpu.allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT));
  DUO_TRY(check(vkBindBufferMemory(gpu.device, out.buffer_, out.memory_, 0)));
  void* data = nullptr;
  DUO_TRY(check(vkMapMemory(gpu.device, out.memory_, 0, VK_WHOLE_SIZE, 0, &data)));
  out.data_ = static_cast<std::uint8_t*>(data);
  return out;
}

HostBuffer::HostBuffer(HostBuffer&& other) noexcept { *this = std::move(other); }

HostBuffer& HostBuffer::operator=(HostBuffer&& other) noexcept {
  std::swap(gpu_, other.gpu_);
  std::swap(buffer_, other.buffer_);
  std::swap(memory_, other.memory_);
  std::swap(data_, other.data_);
  return *this;
}

HostBuffer::~HostBuffer() {
  if (gpu_ == nullptr) return;
  vkDestroyBuffer(gpu_->device, buffer_, nullptr);
  vkFreeMemory(gpu_->device, memory_, nullptr);
}

void change_use(VkCommandBuffer commands, VkImage image, const Use& from, const Use& to) {
  VkImageMemoryBarrier barrier = {};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
  barrier.srcAccessMask = from.access;
  barrier.dstAccessMask = to.access;
  barrier.oldLayout = from.layout;
  barrier.newLayout = to.layout;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  vkCmdPipelineBarrier(commands, from.stage, to.stage, 0, 0, nullptr, 0, nullptr, 1, &barrier);
}

}  // namespace duo::app::view
