// Device: one opened Vulkan device with its one compute queue.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "vulkan/instance.h"

namespace duo::vk {

struct MemoryBlock;

/// Number of submitted work; the work of a device finishes in the order of its tickets.
using Ticket = std::uint64_t;

inline constexpr std::int64_t kWaitNs = 20'000'000'000;  // longer than any frame takes, unless the device hangs

/// Opened device. Buffers, kernels, recorders and timers keep a pointer to it and must be destroyed before it.
///
/// Threads  any
class Device {
 public:
  /// Errors  the device lacks something, or the driver refuses
  static Result<std::unique_ptr<Device>> make(std::shared_ptr<Instance> instance, const PhysicalDevice& physical);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const DeviceInfo& info() const { return physical_.info; }
  /// The supported subgroup size that is nearest to `wanted`, a power of two.
  int subgroup_size_near(int wanted) const {
    return std::clamp(wanted, physical_.least_subgroup_size, physical_.most_subgroup_size);
  }
  /// Errors  not finished within `timeout_ns`, after which it is not waited for again; device lost
  Result<void> wait(Ticket ticket, std::int64_t timeout_ns = kWaitNs) const;
  bool finished(Ticket ticket) const;
  /// How long to wait for a frame before the device counts as hung; the software driver needs long for large pictures.
  std::int64_t patience_ns() const { return info().type == "software" ? kWaitNs : 2'000'000'000; }
  /// Whether a wait timed out. The device may still write to its memory, so that nothing of it can be destroyed.
  bool hung() const { return hung_; }
  /// Writes compiled kernels to the pipeline cache on disk, if there are more than it holds.
  void keep_pipelines() const;

  // For this folder and its tests.
  Result<Ticket> submit(VkCommandBuffer commands);
  VkDevice handle() const { return handle_; }
  const DeviceFunctions& fn() const { return fn_; }
  /// For tests, which replace calls by failing ones.
  DeviceFunctions& calls() { return fn_; }
  const VkPhysicalDeviceMemoryProperties& memory() const { return memory_; }
  std::weak_ptr<MemoryBlock>& last_block(std::uint32_t type, bool mapped) const { return last_blocks_[mapped][type]; }
  VkPipelineCache pipelines() const { return pipelines_; }
  std::uint32_t queue_family() const { return physical_.queue_family; }
  /// Nanoseconds of one tick of the device's clock; 0 where it has none.
  double tick_ns() const { return physical_.tick_ns; }
  double elapsed_ns(std::uint64_t from, std::uint64_t to) const {
    return static_cast<double>((to - from) & physical_.tick_mask) * physical_.tick_ns;
  }
  /// "`tried` on NAME: why"
  Error error(const std::string& tried, VkResult why) const;
  /// The name that validation messages and debuggers show.
  template <class Handle>
  void set_name(Handle object, VkObjectType type, const std::string& name) const {
    set_name_u64(reinterpret_cast<std::uint64_t>(object), type, name);
  }

 private:
  Device() = default;
  void set_name_u64(std::uint64_t object, VkObjectType type, const std::string& name) const;

  std::shared_ptr<Instance> instance_;
  PhysicalDevice physical_;
  VkDevice handle_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  VkSemaphore timeline_ = VK_NULL_HANDLE;  // counts finished tickets
  std::mutex submitting_;
  std::atomic<Ticket> last_ = 0;
  DeviceFunctions fn_;
  VkPhysicalDeviceMemoryProperties memory_{};
  mutable std::array<std::array<std::weak_ptr<MemoryBlock>, VK_MAX_MEMORY_TYPES>, 2> last_blocks_;
  VkPipelineCache pipelines_ = VK_NULL_HANDLE;
  std::size_t pipelines_found_ = 0;  // bytes
  mutable std::atomic<bool> hung_ = false;
};

}  // namespace duo::vk
