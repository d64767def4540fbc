#include "vulkan/memory.h"

#include <algorithm>

namespace duo::vk {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{32} << 20;  // larger buffers have a block to themselves

Result<std::shared_ptr<MemoryBlock>> make_block(const Device& device, std::size_t bytes, std::uint32_t type, bool mapped,
                                                const std::string& tried) {
  auto block = std::make_shared<MemoryBlock>();
  block->bytes = bytes;
  auto info = structure<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
  info.allocationSize = bytes;
  info.memoryTypeIndex = type;
  DUO_TRY_ASSIGN(block->memory, OwnedMemory::make(device, info, tried));
  if (!mapped) return block;
  void* at = nullptr;
  if (const VkResult r = device.fn().vkMapMemory(device.handle(), block->memory.get(), 0, VK_WHOLE_SIZE, 0, &at);
      r != VK_SUCCESS)
    return device.error(tried, r);
  block->mapped = static_cast<std::byte*>(at);
  return block;
}

}  // namespace

Result<MemoryPart> take_memory(const Device& device, const VkMemoryRequirements& needs, std::uint32_t type, bool mapped,
                               const std::string& tried) {
  std::weak_ptr<MemoryBlock>& last = device.last_block(type, mapped);
  if (const auto block = last.lock()) {
    const std::size_t offset = (block->used + needs.alignment - 1) / needs.alignment * needs.alignment;
    if (offset + needs.size <= block->bytes) {
      block->used = offset + needs.size;
      return MemoryPart{block, offset};
    }
  }
  auto block = make_block(device, std::max<std::size_t>(needs.size, kBlockBytes), type, mapped, tried);
  // A device with little memory left may still have as much as is needed.
  if (!block && needs.size < kBlockBytes) block = make_block(device, needs.size, type, mapped, tried);
  DUO_TRY(block);
  (*block)->used = needs.size;
  if (needs.size < kBlockBytes) last = *block;
  return MemoryPart{*block, 0};
}

}  // namespace duo::vk
