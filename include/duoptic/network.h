// The networks of the detectors on their own, on one input: what a benchmark runs.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "duoptic/result.h"

namespace [[gnu::visibility("default")]] duo {

/// A network that is ready to run on an input of waves. Nothing is allocated after open_network().
///
/// Threads  one caller at a time
class Network {
 public:
  virtual ~Network() = default;
  /// Errors  the device is lost, or does not answer in time
  virtual Result<void> run() = 0;
  /// The first values of the first output, in the network's units: what two ways to run agree on.
  virtual std::vector<float> answer() const = 0;
};

/// `engine`: "ref", "simd", "vulkan[:DEVICE]", and in builds with Debian's libxnnpack-dev "XNNPACK": the same layers in
/// floating point by that library.
///
/// Errors  those of the file; an engine that this build lacks
Result<std::unique_ptr<Network>> open_network(const std::filesystem::path& model, const std::string& engine, int threads);

/// Whether this build has XNNPACK.
bool has_xnnpack();

}  // namespace duo
