// Which of the machine's Vulkan devices to compute on.
#pragma once

#include <span>
#include <string_view>

#include "vulkan/instance.h"

namespace duo::vk {

/// `wanted`: its index, or a part of its name in any case; empty: the graphics card, a discrete one before others, never a
/// software driver.
///
/// Errors  no such device; what the one named lacks; no usable graphics card
Result<PhysicalDevice> choose_device(std::span<const PhysicalDevice> devices, std::string_view wanted);

/// Whether the system shows a graphics card at all; much faster than starting every driver.
bool has_card();

}  // namespace duo::vk
