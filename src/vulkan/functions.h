// The Vulkan entry points in use. They are looked up at run time, so that the library links to no Vulkan and a machine
// without it still runs the CPU engines.
#pragma once

#define VK_NO_PROTOTYPES
#include <vulkan/vulkan_core.h>

// clang-format off
#define DUO_VK_INSTANCE_FUNCTIONS(X)                                                                                   \
  X(vkDestroyInstance) X(vkEnumeratePhysicalDevices) X(vkGetPhysicalDeviceProperties)                                  \
  X(vkGetPhysicalDeviceProperties2) X(vkGetPhysicalDeviceFeatures2) X(vkGetPhysicalDeviceMemoryProperties)             \
  X(vkGetPhysicalDeviceQueueFamilyProperties) X(vkCreateDevice) X(vkGetDeviceProcAddr)

// Only there when validation is on.
#define DUO_VK_DEBUG_FUNCTIONS(X)                                                                                      \
  X(vkCreateDebugUtilsMessengerEXT) X(vkDestroyDebugUtilsMessengerEXT) X(vkSetDebugUtilsObjectNameEXT)

#define DUO_VK_DEVICE_FUNCTIONS(X)                                                                                     \
  X(vkDestroyDevice) X(vkGetDeviceQueue) X(vkQueueSubmit)                                                             \
  X(vkCreateSemaphore) X(vkDestroySemaphore) X(vkWaitSemaphores) X(vkGetSemaphoreCounterValue)                         \
  X(vkCreateBuffer) X(vkDestroyBuffer) X(vkGetBufferMemoryRequirements) X(vkBindBufferMemory)                          \
  X(vkAllocateMemory) X(vkFreeMemory) X(vkMapMemory)                                                                   \
  X(vkCreateShaderModule) X(vkDestroyShaderModule) X(vkCreateComputePipelines) X(vkDestroyPipeline)                    \
  X(vkCreatePipelineCache) X(vkDestroyPipelineCache) X(vkGetPipelineCacheData)                                          \
  X(vkCreatePipelineLayout) X(vkDestroyPipelineLayout)                                                                 \
  X(vkCreateDescriptorSetLayout) X(vkDestroyDescriptorSetLayout)                                                       \
  X(vkCreateDescriptorPool) X(vkDestroyDescriptorPool) X(vkAllocateDescriptorSets) X(vkUpdateDescriptorSets)           \
  X(vkCreateCommandPool) X(vkDestroyCommandPool) X(vkResetCommandPool) X(vkAllocateCommandBuffers)                     \
  X(vkBeginCommandBuffer) X(vkEndCommandBuffer) X(vkCmdPipelineBarrier2) X(vkCmdCopyBuffer) X(vkCmdFillBuffer)         \
  X(vkCmdBindPipeline) X(vkCmdBindDescriptorSets) X(vkCmdPushConstants) X(vkCmdDispatch) X(vkCmdDispatchIndirect)                               \
  X(vkCreateQueryPool) X(vkDestroyQueryPool) X(vkCmdResetQueryPool) X(vkCmdWriteTimestamp2) X(vkGetQueryPoolResults)
// clang-format on

namespace duo::vk {

#define DUO_VK_MEMBER(name) PFN_##name name = nullptr;
struct InstanceFunctions {
  DUO_VK_INSTANCE_FUNCTIONS(DUO_VK_MEMBER)
  DUO_VK_DEBUG_FUNCTIONS(DUO_VK_MEMBER)
};
struct DeviceFunctions {
  DUO_VK_DEVICE_FUNCTIONS(DUO_VK_MEMBER)
};
#undef DUO_VK_MEMBER

/// A structure that says what it is; all else is zero.
template <class T>
T structure(VkStructureType type, void* next = nullptr) {
  T out{};
  out.sType = type;
  out.pNext = next;
  return out;
}

}  // namespace duo::vk
