// A device of its own for a test, whose driver can be watched and made to fail.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <ctime>
#include <memory>
#include <utility>

#include "engines/engines.h"
#include "tests/agree_vk.h"

namespace duo::test {

/// As an engine owns it; validation is silent at the end.
class OwnDevice {
 public:
  explicit OwnDevice(vk::Validation validation = vk::Validation::kOn) : instance_(must(vk::Instance::open(validation))) {
    device_ = must(vk::Device::make(instance_, must(instance_->devices()).front()));
  }
  ~OwnDevice() {
    for (const std::string& message : instance_->messages()) ADD_FAILURE() << message;
  }
  vk::DeviceFunctions& calls() { return device_->calls(); }
  std::unique_ptr<Engine> engine() { return make_vulkan_engine(std::move(device_), 2); }

 private:
  std::shared_ptr<vk::Instance> instance_;
  std::unique_ptr<vk::Device> device_;
};

// What the driver does, by call: how often, and how long on this thread's clock.
struct Calls {
  int submits = 0, waits = 0, fail_submit_at = -1, fail_wait_at = -1, hang_at = -1, allocations_left = 1 << 30;
  std::int64_t inside_ns = 0;
  vk::DeviceFunctions real;
};
inline Calls calls;

inline std::int64_t thread_ns() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

/// How many times 100 us of this thread's clock a copy of 1 MiB takes at the moment, 1 at least. A machine to itself needs less
/// than one; where others share its processor, the clock runs on meanwhile, and 20 to 70 were seen.
inline double slowdown() {
  constexpr double kBest_ns = 100'000;
  static std::array<char, 1 << 20> from, to;
  const std::int64_t begin = thread_ns();
  std::copy(from.begin(), from.end(), to.begin());
  return std::max(1.0, static_cast<double>(thread_ns() - begin) / kBest_ns);
}

template <class F>
auto inside(F&& f) {
  const std::int64_t begin = thread_ns();
  const auto result = f();
  calls.inside_ns += thread_ns() - begin;
  return result;
}

inline void watch(vk::DeviceFunctions& table) {
  calls = {};
  calls.real = table;
  table.vkQueueSubmit = [](VkQueue queue, std::uint32_t count, const VkSubmitInfo* info, VkFence fence) {
    if (calls.submits++ == calls.fail_submit_at) return VK_ERROR_DEVICE_LOST;
    return inside([&] { return calls.real.vkQueueSubmit(queue, count, info, fence); });
  };
  // The work itself ends, as that of a lost device never would: what it uses may be freed.
  table.vkWaitSemaphores = [](VkDevice device, const VkSemaphoreWaitInfo* info, std::uint64_t timeout_ns) {
    if (calls.hang_at >= 0 && calls.waits >= calls.hang_at) return VK_TIMEOUT;  // its work goes on meanwhile
    const VkResult r = inside([&] { return calls.real.vkWaitSemaphores(device, info, timeout_ns); });
    return calls.waits++ == calls.fail_wait_at ? VK_ERROR_DEVICE_LOST : r;
  };
  table.vkGetSemaphoreCounterValue = [](VkDevice device, VkSemaphore semaphore, std::uint64_t* value) {
    if (calls.hang_at >= 0 && calls.waits >= calls.hang_at) return *value = 0, VK_SUCCESS;
    return inside([&] { return calls.real.vkGetSemaphoreCounterValue(device, semaphore, value); });
  };
  table.vkAllocateMemory = [](VkDevice device, const VkMemoryAllocateInfo* info, const VkAllocationCallbacks* with,
                              VkDeviceMemory* out) {
    if (calls.allocations_left-- <= 0) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    return calls.real.vkAllocateMemory(device, info, with, out);
  };
}

}  // namespace duo::test
