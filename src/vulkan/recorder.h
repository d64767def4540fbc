// Recorder: a list of dispatches and copies, recorded once and submitted as often as wanted.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include "core/check.h"
#include "vulkan/buffer.h"
#include "vulkan/kernel.h"

namespace duo::vk {

/// How a command uses a buffer.
struct Use {
  VkBuffer buffer;
  bool writes;
};
template <class T>
Use reads(const BufferView<T>& view) {
  return {view.buffer->handle(), false};
}
template <class T>
Use writes(const BufferView<T>& view) {
  return {view.buffer->handle(), true};
}

inline Use reads(const Buffer& buffer) { return {buffer.handle(), false}; }
inline Use writes(const Buffer& buffer) { return {buffer.handle(), true}; }

/// Workgroups of kGroupWidth x kGroupHeight that cover a picture.
inline Size groups_for(Size size) {
  return {(size.width + kGroupWidth - 1) / kGroupWidth, (size.height + kGroupHeight - 1) / kGroupHeight};
}

class Timer;

/// Records commands; puts a barrier before each that needs the results, or overwrites the inputs, of those before it.
/// Recording cannot fail on the spot: the first error is kept, and end() returns it.
///
/// Threads  one
class Recorder {
 public:
  static Result<Recorder> make(Device& device);
  Recorder(Recorder&&) = default;
  Recorder& operator=(Recorder&&) = delete;
  ~Recorder();  // waits for its work

  /// Starts anew. An error, like that of submit() and run(), if the work recorded before is not finished.
  ///
  /// `timer`: gets the time of each stage(); must outlive the recording
  void begin(Timer* timer = nullptr);
  /// Ends the part that was recorded since the last call; `name` lives as long as the timer.
  void stage(const char* name);
  /// Runs `kernel` in `groups` workgroups; the order of `uses` is that of the kernel's bindings.
  template <class Push>
  void dispatch(const Kernel& kernel, const Push& push, std::initializer_list<Use> uses, Size groups) {
    dispatch_bytes(kernel, std::as_bytes(std::span(&push, 1)), uses, groups);
  }
  /// The same, in as many workgroups as an earlier kernel wrote into `groups`: three words x, y, z at `offset` bytes, a
  /// multiple of 4.
  template <class Push>
  void dispatch_indirect(const Kernel& kernel, const Push& push, std::initializer_list<Use> uses, const Buffer& groups,
                         std::size_t offset = 0) {
    dispatch_indirect_bytes(kernel, std::as_bytes(std::span(&push, 1)), uses, groups, offset);
  }
  /// Sets every word of a buffer.
  void fill(const Buffer& dst, std::uint32_t word);
  /// Copies the first `bytes` of a buffer.
  void copy(const Buffer& src, const Buffer& dst, std::size_t bytes);
  Result<void> end();

  /// Starts the recorded work.
  Result<Ticket> submit();
  /// submit() and wait.
  Result<void> run(std::int64_t timeout_ns = kWaitNs);
  /// No command may be recorded after an error.
  bool ok() const { return failed_.has_value(); }
  VkCommandBuffer commands() const { return commands_; }

 private:
  struct Set {
    VkDescriptorSetLayout layout;
    std::vector<VkBuffer> buffers;
    VkDescriptorSet handle;
  };

  explicit Recorder(Device& device) : device_(&device) {}
  void dispatch_bytes(const Kernel& kernel, std::span<const std::byte> push, std::span<const Use> uses, Size groups);
  void dispatch_indirect_bytes(const Kernel& kernel, std::span<const std::byte> push, std::span<const Use> uses,
                               const Buffer& groups, std::size_t offset);
  /// Binds all that a dispatch needs and puts it after what it depends on; false after an error.
  bool bind(const Kernel& kernel, std::span<const std::byte> push, std::span<const Use> uses, std::span<const Use> ordered);
  void order(std::span<const Use> uses);
  void barrier(VkPipelineStageFlags2 until, VkAccessFlags2 access);
  VkDescriptorSet set_for(const Kernel& kernel, std::span<const Use> uses);
  Result<VkDescriptorSet> allocate_set(VkDescriptorSetLayout layout);

  Device* device_;
  OwnedCommandPool command_pool_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  std::vector<OwnedSetPool> descriptor_pools_;
  std::vector<Set> sets_;       // every set of this recording; a set lives as long as the recording
  std::vector<Use> unordered_;  // uses since the last barrier
  Timer* timer_ = nullptr;
  Result<void> failed_;
  Ticket last_ = 0;
};

/// A buffer on the device that holds these bytes once this returns.
///
/// Errors  those of Buffer::make() and Recorder::run()
Result<Buffer> make_filled(Device& device, const std::string& name, std::span<const std::byte> bytes);

}  // namespace duo::vk
