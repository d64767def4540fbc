// Kernel: one compute shader, ready to be dispatched by a Recorder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "vulkan/owned.h"

namespace duo::vk {

/// What a kernel is made of. Bindings are storage buffers 0 .. buffers - 1 of set 0.
struct KernelSource {
  const char* name;
  std::span<const std::uint32_t> spirv;
  int buffers;
  std::size_t push_bytes;                         // <= 128
  std::span<const std::uint32_t> constants = {};  // specialisation constants 0, 1, …
  int subgroup_size = 0;                          // the one it must run at, with all subgroups full; 0: any
};

/// Move-only; must outlive the recordings that use it.
class Kernel {
 public:
  /// Errors  the driver refuses the shader
  static Result<Kernel> make(const Device& device, const KernelSource& source);

  int buffers() const { return buffers_; }
  std::size_t push_bytes() const { return push_bytes_; }
  VkPipeline pipeline() const { return pipeline_.get(); }
  VkPipelineLayout layout() const { return layout_.get(); }
  VkDescriptorSetLayout set_layout() const { return set_layout_.get(); }

 private:
  int buffers_ = 0;
  std::size_t push_bytes_ = 0;
  OwnedSetLayout set_layout_;
  OwnedLayout layout_;
  OwnedPipeline pipeline_;
};

}  // namespace duo::vk
