#include "vulkan/buffer.h"

#include <fmt/format.h>

#include <optional>

#include "core/check.h"
#include "vulkan/memory.h"

namespace duo::vk {
namespace {

std::optional<std::uint32_t> find_memory(const VkPhysicalDeviceMemoryProperties& all, std::uint32_t allowed,
                                         VkMemoryPropertyFlags wanted) {
  for (std::uint32_t i = 0; i < all.memoryTypeCount; ++i)
    if ((allowed >> i & 1) != 0 && (all.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
  return std::nullopt;
}

std::uint32_t memory_type(const Device& device, std::uint32_t allowed, Memory memory) {
  // Vulkan promises a type of each of these sets for buffers; cached only makes reading on the CPU faster.
  constexpr VkMemoryPropertyFlags kFast = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
  constexpr VkMemoryPropertyFlags kMapped = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  if (memory == Memory::kDownload)
    if (const auto cached = find_memory(device.memory(), allowed, kMapped | VK_MEMORY_PROPERTY_HOST_CACHED_BIT)) return *cached;
  const auto plain = find_memory(device.memory(), allowed, memory == Memory::kDevice ? kFast : kMapped);
  DUO_CHECK(plain.has_value());
  return *plain;
}

}  // namespace

Result<Buffer> Buffer::make(const Device& device, const std::string& name, std::size_t bytes, Memory memory) {
  DUO_CHECK(bytes > 0);
  bytes = (bytes + 3) & ~std::size_t{3};  // kernels may fetch whole words
  const std::string tried = fmt::format("making buffer \"{}\" of {} bytes", name, bytes);
  if (bytes > kMaxBytes)
    return Error{ErrorCode::kUnsupported,
                 fmt::format("{}: at most {} fit: use smaller pictures or a CPU engine", tried, kMaxBytes)};
  const DeviceFunctions& fn = device.fn();

  Buffer out;
  out.bytes_ = bytes;
  auto info = structure<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
  info.size = bytes;
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
               VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  DUO_TRY_ASSIGN(out.buffer_, OwnedBuffer::make(device, info, tried));
  VkBuffer buffer = out.buffer_.get();
  device.set_name(buffer, VK_OBJECT_TYPE_BUFFER, name);

  VkMemoryRequirements needs;
  fn.vkGetBufferMemoryRequirements(device.handle(), buffer, &needs);
  const bool mapped = memory != Memory::kDevice;
  DUO_TRY_ASSIGN(MemoryPart part, take_memory(device, needs, memory_type(device, needs.memoryTypeBits, memory), mapped, tried));
  out.block_ = std::move(part.block);
  if (const VkResult r = fn.vkBindBufferMemory(device.handle(), buffer, out.block_->memory.get(), part.offset); r != VK_SUCCESS)
    return device.error(tried, r);
  if (mapped) out.mapped_ = {out.block_->mapped + part.offset, bytes};
  return out;
}

}  // namespace duo::vk
