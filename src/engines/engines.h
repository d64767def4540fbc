// The engines by name; include/duoptic/engine.h is what others see.
#pragma once

#include <memory>
#include <string_view>

#include "duoptic/engine.h"

namespace duo {
namespace vk {
class Device;
}

std::unique_ptr<Engine> make_ref_engine();
std::unique_ptr<Engine> make_simd_engine(int threads);

/// The engine of a device; `threads` are for the CPU, should the device be lost.
std::unique_ptr<Engine> make_vulkan_engine(std::unique_ptr<vk::Device> device, int threads);
/// The same by vk::choose_device().
///
/// Errors  no Vulkan on this machine or in this build, no such device, or it lacks something
Result<std::unique_ptr<Engine>> make_vulkan_engine(std::string_view wanted, int threads);
/// Whether "auto" should try: the system shows a graphics card, and this build can use it.
bool may_have_card();

}  // namespace duo
