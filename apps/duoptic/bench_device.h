// What `bench --engine vulkan` measures: time on the device and on the CPU, latency, throughput, bytes each way.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "duoptic/result.h"
#include "duoptic/synthetic.h"

namespace duo::app::bench {

struct DeviceBench {
  std::string engine;  // "vulkan" or "vulkan:DEVICE"
  const SyntheticPair* input;
  std::vector<std::pair<std::string, std::string>> choices;  // matcher, preset
  int max_disparity, repeat;
  bool json;  // else each line is printed as soon as it is known
};

/// Each choice without any map sent back, and with all. Latency: from pictures in the CPU's memory to the collected frame; CPU:
/// of the calling thread, the driver's share included; frames/s with as many pairs in flight as the engine takes.
///
/// Errors  those of make_engine(); the device was lost
Result<nlohmann::json> device_table(const DeviceBench& what);

}  // namespace duo::app::bench
