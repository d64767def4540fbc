#include "vulkan/device.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <mutex>
#include <utility>
#include <vector>

#include "vulkan/pipeline_cache.h"

namespace duo::vk {
namespace {

/// An instance must not go before its devices.
void keep_to_the_end(std::shared_ptr<Instance> instance) {
  static std::mutex mutex;
  static auto* const kept = new std::vector<std::shared_ptr<Instance>>;
  const std::lock_guard lock(mutex);
  kept->push_back(std::move(instance));
}

}  // namespace

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
  f13.subgroupSizeControl = VK_TRUE;
  f13.computeFullSubgroups = VK_TRUE;
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

  const std::string found = read_pipelines(pipeline_file(physical.pipelines_id));
  device->pipelines_found_ = found.size();
  auto cache = structure<VkPipelineCacheCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO);
  cache.initialDataSize = found.size();
  cache.pInitialData = found.data();
  if (const VkResult r = device->fn_.vkCreatePipelineCache(device->handle_, &cache, nullptr, &device->pipelines_);
      r != VK_SUCCESS)
    return device->error("making a pipeline cache", r);
  // What the driver took of it, which is next to nothing if the file is of another card or driver.
  std::size_t taken = 0;
  if (device->fn_.vkGetPipelineCacheData(device->handle_, device->pipelines_, &taken, nullptr) == VK_SUCCESS)
    device->pipelines_found_ = taken;
  return device;
}

void Device::keep_pipelines() const {
  std::size_t bytes = 0;
  if (fn_.vkGetPipelineCacheData(handle_, pipelines_, &bytes, nullptr) != VK_SUCCESS || bytes <= pipelines_found_) return;
  std::string data(bytes, '\0');
  if (fn_.vkGetPipelineCacheData(handle_, pipelines_, &bytes, data.data()) != VK_SUCCESS) return;
  data.resize(bytes);
  write_pipelines(pipeline_file(physical_.pipelines_id), data);
}

Device::~Device() {
  if (handle_ == VK_NULL_HANDLE) return;
  // A device that hangs can neither be waited for without end nor destroyed: it is left to the end of the program.
  if (timeline_ != VK_NULL_HANDLE) (void)wait(last_.load());
  if (hung_) {
    keep_to_the_end(std::move(instance_));
    return;
  }
  if (pipelines_ != VK_NULL_HANDLE) fn_.vkDestroyPipelineCache(handle_, pipelines_, nullptr);
  if (timeline_ != VK_NULL_HANDLE) fn_.vkDestroySemaphore(handle_, timeline_, nullptr);
  fn_.vkDestroyDevice(handle_, nullptr);
}

Result<Ticket> Device::submit(VkCommandBuffer commands) {
  // Not vkQueueSubmit2: with it the validation layer (1.3.239) waits in vain when it looks into kernels.
  const std::lock_guard lock(submitting_);
  const Ticket ticket = last_ + 1;
  auto timeline = structure<VkTimelineSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO);
  timeline.signalSemaphoreValueCount = 1;
  timeline.pSignalSemaphoreValues = &ticket;
  auto info = structure<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO, &timeline);
  info.commandBufferCount = 1;
  info.pCommandBuffers = &commands;
  info.signalSemaphoreCount = 1;
  info.pSignalSemaphores = &timeline_;
  if (const VkResult r = fn_.vkQueueSubmit(queue_, 1, &info, VK_NULL_HANDLE); r != VK_SUCCESS)
    return error("submitting work", r);
  return last_ = ticket;
}

Result<void> Device::wait(Ticket ticket, std::int64_t timeout_ns) const {
  if (hung_ && !finished(ticket)) return error("waiting for work", VK_TIMEOUT);
  auto info = structure<VkSemaphoreWaitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO);
  info.semaphoreCount = 1;
  info.pSemaphores = &timeline_;
  info.pValues = &ticket;
  const VkResult r = fn_.vkWaitSemaphores(handle_, &info, static_cast<std::uint64_t>(timeout_ns));
  if (r == VK_TIMEOUT && ticket <= last_) hung_ = true;
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
