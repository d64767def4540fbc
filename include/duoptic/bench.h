// Speed: of frames and their stages beside OpenCV's matchers, on the CPU and on a device; of networks beside XNNPACK; of the
// whole way from two videos to joints. Contestants take turns in one process, and medians are told. All tables are JSON; `say`
// is given the same as lines of text, each as soon as it is known.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "duoptic/result.h"
#include "duoptic/synthetic.h"
#include "duoptic/timing.h"

namespace [[gnu::visibility("default")]] duo {

using SayLine = std::function<void(const std::string&)>;

struct FramesBench {
  std::string engine = "both";  // simd, ref, or both
  int threads = 1;
  int repeat = 11;
  bool fine = false;  // the matcher fine, too: seconds a frame
};
/// Our engines with several matchers and presets, from decoded pictures to depth; OpenCV's get the same rectified pair, and
/// their time is that of the matching call alone.
///
/// Errors  those of make_engine() and Engine::prepare()
Result<std::string> bench_frames(const SyntheticPair& input, const FramesBench& what, const SayLine& say);

/// The same choices on a device, "vulkan" or "vulkan:DEVICE", without any map sent back, and with all. Latency: from pictures
/// in the CPU's memory to the collected frame; CPU: of the calling thread, the driver's share included; frames/s with as many
/// pairs in flight as the engine takes.
///
/// Errors  those of make_engine(); the device was lost
Result<std::string> bench_device(const SyntheticPair& input, const std::string& engine, int repeat, const SayLine& say);

/// Every network that there is, on one and on two threads; on a device once. XNNPACK's floating point, where the build has it,
/// takes turns. `engine`: "simd", "ref", "vulkan" or "vulkan:DEVICE".
///
/// Errors  a network's file is broken; the device
Result<std::string> bench_networks(const std::string& engine, int repeat, const SayLine& say);

/// Of a clip, a folder with left.avi, right.avi and calibration_truth.yml: CPU time and bytes a frame of each part, while one
/// thread does one part after the other; and frames/s, CPU time and busy cores of `duoptic track` with one thread and with two.
/// Means over the clip's frames, medians over the runs. `whole`: each frame is matched as a whole, and not around people.
///
/// Errors  those of load_rig(), open_pairs(), Pipeline and make_json_lines(); no room for the lines
Result<std::string> bench_clip(const std::filesystem::path& folder, const std::string& engine, bool whole, int repeat,
                               const SayLine& say);

}  // namespace duo
