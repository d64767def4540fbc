// Memory: few large blocks of device memory, of which buffers take their parts.
#pragma once

#include <cstddef>
#include <memory>

#include "vulkan/owned.h"

namespace duo::vk {

/// Freed with the last buffer in it.
struct MemoryBlock {
  OwnedMemory memory;
  std::size_t bytes = 0, used = 0;
  std::byte* mapped = nullptr;  // null where the CPU does not reach it
};

/// A buffer's part of a block.
struct MemoryPart {
  std::shared_ptr<MemoryBlock> block;
  std::size_t offset = 0;
};

/// A part of the device's last block of this memory type, or the first of a new one: drivers allow few allocations (4096 on
/// some), and each is slow.
///
/// Errors  out of memory; `tried` starts the line
Result<MemoryPart> take_memory(const Device& device, const VkMemoryRequirements& needs, std::uint32_t type, bool mapped,
                               const std::string& tried);

}  // namespace duo::vk
