// Buffer: memory that kernels read and write. BufferView: a picture inside one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "duoptic/image.h"
#include "duoptic/result.h"
#include "vulkan/owned.h"
#include "vulkan/plane.h"

namespace duo::vk {

struct MemoryBlock;

enum class Memory : std::uint8_t {
  kDevice,    // where kernels are fastest; not mapped
  kUpload,    // the CPU writes, kernels and copies read
  kDownload,  // copies write, the CPU reads
};

/// Move-only; must outlive the work that uses it.
class Buffer {
 public:
  static constexpr std::size_t kMaxBytes = std::size_t{128} << 20;  // the least limit of a storage buffer that Vulkan allows
  /// `name` is for error and validation messages; bytes > 0.
  ///
  /// Errors   more than kMaxBytes, out of memory
  /// Threads  one at a time for a device
  static Result<Buffer> make(const Device& device, const std::string& name, std::size_t bytes, Memory memory);

  std::size_t bytes() const { return bytes_; }
  /// Empty for Memory::kDevice. Work submitted later sees what the CPU wrote; after wait() the CPU sees what the work wrote.
  std::span<std::byte> mapped() const { return mapped_; }
  VkBuffer handle() const { return buffer_.get(); }

 private:
  std::size_t bytes_ = 0;
  std::span<std::byte> mapped_;
  // In this order: a buffer is destroyed before its memory.
  std::shared_ptr<MemoryBlock> block_;
  OwnedBuffer buffer_;
};

/// Pixels of type T in a buffer that it does not own; free to copy. Default: absent.
template <class T>
struct BufferView {
  const Buffer* buffer = nullptr;
  Plane plane{};  // in elements of T

  BufferView() = default;
  BufferView(const Buffer& from, Plane where) : buffer(&from), plane(where) {}
  bool absent() const { return buffer == nullptr; }
  /// Whether a picture of this size lies wholly inside the buffer.
  bool holds(Size size) const {
    if (absent() || size.empty() || plane.offset < 0 || plane.stride < size.width) return false;
    const std::size_t end = plane.offset + static_cast<std::size_t>(plane.stride) * (size.height - 1) + size.width;
    return end * sizeof(T) <= buffer->bytes();
  }
};

}  // namespace duo::vk
