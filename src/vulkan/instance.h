// Instance: Vulkan on this machine, its devices, and what the validation layer says.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "duoptic/devices.h"
#include "duoptic/result.h"
#include "vulkan/functions.h"

namespace duo::vk {

/// What the validation layer checks; tests demand zero messages.
enum class Validation : std::uint8_t {
  kOff,
  kOn,           // calls and synchronisation
  kGpuAssisted,  // calls, and the bounds of every access in kernels; slow
};

/// A device of this machine before it is opened.
struct PhysicalDevice {
  VkPhysicalDevice handle = VK_NULL_HANDLE;
  DeviceInfo info;
  std::uint32_t queue_family = 0;
  int least_subgroup_size = 0, most_subgroup_size = 0;  // a kernel can be made to run at any power of two of these
  std::string pipelines_id;                             // of the pipeline cache: device and driver
  double tick_ns = 0;                                   // of its time stamps; 0: it has none
  std::uint64_t tick_mask = 0;                          // the bits of a time stamp that count
};

/// The loader stays open until the program ends: some drivers cannot be unloaded cleanly.
///
/// Threads  any
class Instance {
 public:
  /// Errors  no loader, no driver, or validation asked for and its layer not installed
  static Result<std::shared_ptr<Instance>> open(Validation validation, const char* library = "libvulkan.so.1");
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  /// Errors  no device at all; devices that lack something are listed, with what they lack
  Result<std::vector<PhysicalDevice>> devices() const;
  /// All warnings and errors of the validation layer so far.
  std::vector<std::string> messages() const;
  const InstanceFunctions& fn() const { return fn_; }

 private:
  Instance() = default;
  Result<void> create(Validation validation, PFN_vkGetInstanceProcAddr get);
  PhysicalDevice inspect(VkPhysicalDevice handle) const;
  static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                                   const VkDebugUtilsMessengerCallbackDataEXT* data, void* instance);

  VkInstance handle_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  InstanceFunctions fn_;
  mutable std::mutex mutex_;
  std::vector<std::string> messages_;
};

/// "out of device memory", …
std::string describe(VkResult result);

}  // namespace duo::vk
