// Activations of a network on a device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "vulkan/buffer.h"
#include "vulkan/value_lanes.h"

namespace duo::vk {

/// The same tensor of several pictures: value i of picture p lies at plane.offset + p * plane.stride + i, as core/tensor.h has
/// it.
struct Tensors16 {
  BufferView<std::int16_t> view;
  Size size;
  int channels = 0, pictures = 1;

  int pixels() const { return size.width * size.height; }
  int count() const { return pixels() * channels; }
  /// Whether all lie inside the buffer.
  bool held() const { return view.holds({count(), pictures}); }
};

/// Workgroups of kValueLanes that have an invocation for each value of each picture.
inline Size groups_for(const Tensors16& tensors) {
  return {(tensors.count() + kValueLanes - 1) / kValueLanes, tensors.pictures};
}

}  // namespace duo::vk
