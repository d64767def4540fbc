#include "vulkan/speed.h"

#include <algorithm>
#include <chrono>
#include <vector>

#include "duoptic/statistics.h"
#include "vulkan/recorder.h"

namespace duo::vk {
namespace {

Result<double> median_s(Device& device, const Buffer& from, const Buffer& to) {
  constexpr std::size_t kRuns = 9;
  DUO_TRY_ASSIGN(Recorder recorder, Recorder::make(device));
  recorder.begin();
  recorder.copy(from, to, from.bytes());
  DUO_TRY(recorder.end());
  std::vector<double> seconds;
  for (std::size_t i = 0; i < kRuns; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    DUO_TRY(recorder.run());
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return median(seconds);
}

}  // namespace

Result<DeviceSpeed> copy_speed(Device& device) {
  constexpr std::size_t kBytes = std::size_t{64} << 20;
  constexpr double kGb = kBytes * 1e-9;
  DUO_TRY_ASSIGN(const Buffer a, Buffer::make(device, "copied from", kBytes, Memory::kDevice));
  DUO_TRY_ASSIGN(const Buffer b, Buffer::make(device, "copied to", kBytes, Memory::kDevice));
  DUO_TRY_ASSIGN(const Buffer up, Buffer::make(device, "copied up", kBytes, Memory::kUpload));
  DUO_TRY_ASSIGN(const Buffer down, Buffer::make(device, "copied down", kBytes, Memory::kDownload));
  DUO_TRY_ASSIGN(const double up_s, median_s(device, up, a));
  DUO_TRY_ASSIGN(const double across_s, median_s(device, a, b));
  DUO_TRY_ASSIGN(const double down_s, median_s(device, b, down));
  return DeviceSpeed{2 * kGb / across_s, kGb / up_s, kGb / down_s};
}

}  // namespace duo::vk
