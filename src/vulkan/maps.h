// Maps on a device: rows without gaps, copied up and down as they are.
#pragma once

#include <cstring>

#include "vulkan/buffer.h"

namespace duo::vk {

template <class T>
BufferView<T> whole(const Buffer& buffer, Size size) {
  return {buffer, {0, size.width}};
}

/// Errors  those of Buffer::make()
template <class T>
Result<void> make_map(const Device& device, const char* name, Size size, Buffer& out, Memory memory = Memory::kDevice) {
  const auto pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  DUO_TRY_ASSIGN(out, Buffer::make(device, name, pixels * sizeof(T), memory));
  return {};
}

template <class T>
void pack(const Image<T>& src, const Buffer& dst) {
  const std::size_t row = static_cast<std::size_t>(src.width()) * sizeof(T);
  for (int y = 0; y < src.height(); ++y) std::memcpy(dst.mapped().data() + static_cast<std::size_t>(y) * row, src.row(y), row);
}

/// Does nothing where either is empty, since that map is not wanted.
template <class T>
void unpack(const Buffer& src, Image<T>& dst) {
  if (src.bytes() == 0 || dst.empty()) return;
  const std::size_t row = static_cast<std::size_t>(dst.width()) * sizeof(T);
  for (int y = 0; y < dst.height(); ++y) std::memcpy(dst.row(y), src.mapped().data() + static_cast<std::size_t>(y) * row, row);
}

}  // namespace duo::vk
