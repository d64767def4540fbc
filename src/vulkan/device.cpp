#include "vulkan/device.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

namespace duo::vk {
Result<std::unique_ptr<Device>> Device::make(std::shared_ptr<Instance> instance, const PhysicalDevice& physical) {
  if (!physical.info.lacks.empty())
    return Error{ErrorCode::kUnsupported, fmt::format("opening Vulkan device {}: it lacks {}: update its driver or use another",
                                                      physical.info.name, fmt::join(physical.info.lacks, ", "))};
  std::unique_ptr<Device> device(new Device);
  device->instance_ = std::move(instance);
  device->physical_ = physical;
  const InstanceFunctions& fn = device->instance_->fn();
  fn.vkGetPhysicalDeviceMemoryProperties(physical.handle, &device->memory_);

  auto f13 = structure<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
  f13.synchronization2 = VK_TRUE;
  f13.maintenance4 = VK_TRUE;  // glslc states workgroup sizes in its way
  auto f12 = structure<VkPhysicalDeviceVulkan12Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &f13);
  f12.storageBuffer8BitAccess = VK_TRUE;
  f12.timelineSemaphore = VK_TRUE;
  auto f11 = structure<VkPhysicalDeviceVulkan11Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES, &f12);
  f11.storageBuffer16BitAccess = VK_TRUE;
  const float priority = 1;
  auto queue = structure<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
  queue.queueFamilyIndex = physical.queue_family;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  auto features = structure<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &f11);
  features.features.shaderInt64 = VK_TRUE;  // sums over pictures
  auto info = structure<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features);
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  VkDevice handle = VK_NULL_HANDLE;
  if (const VkResult r = fn.vkCreateDevice(physical.handle, &info, nullptr, &handle); r != VK_SUCCESS)
    return device->error("opening the device", r);
  device->handle_ = handle;

#define DUO_VK_LOAD(name) device->fn_.name = reinterpret_cast<PFN_##name>(fn.vkGetDeviceProcAddr(device->handle_, #name));
  DUO_VK_DEVICE_FUNCTIONS(DUO_VK_LOAD)
#undef DUO_VK_LOAD
  device->fn_.vkGetDeviceQueue(device->handle_, physical.queue_family, 0, &device->queue_);
  auto timeline = structure<VkSemaphoreTypeCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO);
  timeline.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
  const auto semaphore = structure<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &timeline);
  if (const VkResult r = device->fn_.vkCreateSemaphore(device->handle_, &semaphore, nullptr, &device->timeline_);
      r != VK_SUCCESS)
    return device->error("making a semaphore", r);
  return device;
}

Device::~Device() {
  if (handle_ == VK_NULL_HANDLE) return;
  // A device that hangs can neither be waited for without end nor destroyed: it is left to the end of the program.
  if (timeline_ != VK_NULL_HANDLE && !wait(last_)) return;
  if (timeline_ != VK_NULL_HANDLE) fn_.vkDestroySemaphore(handle_, timeline_, nullptr);
  fn_.vkDestroyDevice(handle_, nullptr);
}

Result<Ticket> Device::submit(VkCommandBuffer commands) {
  auto what = structure<VkCommandBufferSubmitInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO);
  what.commandBuffer = commands;
  auto signal = structure<VkSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO);
  signal.semaphore = timeline_;
  signal.value = last_ + 1;
  signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  auto info = structure<VkSubmitInfo2>(VK_STRUCTURE_TYPE_SUBMIT_INFO_2);
  info.commandBufferInfoCount = 1;
  info.pCommandBufferInfos = &what;
  info.signalSemaphoreInfoCount = 1;
  info.pSignalSemaphoreInfos = &signal;
  if (const VkResult r = fn_.vkQueueSubmit2(queue_, 1, &info, VK_NULL_HANDLE); r != VK_SUCCESS)
    return error("submitting work", r);
  return ++last_;
}

Result<void> Device::wait(Ticket ticket, std::int64_t timeout_ns) const {
  auto info = structure<VkSemaphoreWaitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO);
  info.semaphoreCount = 1;
  info.pSemaphores = &timeline_;
  info.pValues = &ticket;
  const VkResult r = fn_.vkWaitSemaphores(handle_, &info, static_cast<std::uint64_t>(timeout_ns));
  if (r != VK_SUCCESS) return error(fmt::format("waiting {} ms for work", timeout_ns / 1'000'000), r);
  return {};
}

bool Device::finished(Ticket ticket) const {
  std::uint64_t done = 0;
  return fn_.vkGetSemaphoreCounterValue(handle_, timeline_, &done) == VK_SUCCESS && done >= ticket;
}

Error Device::error(const std::string& tried, VkResult why) const {
  const bool lost = why == VK_ERROR_DEVICE_LOST || why == VK_TIMEOUT || why == VK_NOT_READY;
  return {lost ? ErrorCode::kDeviceLost : ErrorCode::kUnsupported,
          fmt::format("{} on {}: {}: {}", tried, physical_.info.name, describe(why),
                      lost ? "start again, or use a CPU engine" : "use smaller pictures, another device or a CPU engine")};
}

void Device::set_name_u64(std::uint64_t object, VkObjectType type, const std::string& name) const {
  if (instance_->fn().vkSetDebugUtilsObjectNameEXT == nullptr) return;
  auto info = structure<VkDebugUtilsObjectNameInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT);
  info.objectType = type;
  info.objectHandle = object;
  info.pObjectName = name.c_str();
  // A name that cannot be set is no reason to fail.
  (void)instance_->fn().vkSetDebugUtilsObjectNameEXT(handle_, &info);
}

}  // namespace duo::vk
