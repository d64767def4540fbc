// What every matcher on a device takes and gives.
#pragma once

#include "vulkan/buffer.h"

namespace duo::vk {

/// GrayPair on the device; the inside pictures are there exactly if the setup is masked.
struct MatchInput {
  BufferView<std::uint8_t> left = {}, right = {}, left_inside = {}, right_inside = {};
  const Buffer* coding_noise_q4 = nullptr;  // one word; absent: 0
};

/// Match on the device; confidence may be absent = not wanted.
struct MatchOutput {
  BufferView<std::uint16_t> d_q4 = {};
  BufferView<std::uint8_t> confidence = {};
};

}  // namespace duo::vk
