// What `bench --what networks` measures: the detectors' networks, beside the same layers in floating point by XNNPACK.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "duoptic/result.h"

namespace duo::app::bench {

struct NetworksBench {
  std::string engine;  // "simd", "ref", "vulkan" or "vulkan:DEVICE"
  int repeat;
  bool json;  // else each line is printed as soon as it is known
};

/// Every network that there is, on one and on two threads; on a device once. Ours and XNNPACK's, where the build has it, take
/// turns in one process.
///
/// Errors  a network's file is broken; the device
Result<nlohmann::json> networks_table(const NetworksBench& what);

}  // namespace duo::app::bench
