// The matchers on a device.
#pragma once

#include "matchers/fine/fine_vk.h"
#include "matchers/matchers.h"
#include "matchers/pyramid/pyramid_vk.h"
#include "matchers/sgm/sgm_vk.h"

namespace duo::vk {

using VulkanMatcher = Matchers::Vulkan;

}  // namespace duo::vk
