// What travels through the pipeline: pictures, pairs, and the frame that the engine makes of a pair.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "duoptic/image.h"
#include "duoptic/rig.h"
#include "duoptic/window.h"

namespace [[gnu::visibility("default")]] duo {

using TimeNs = std::int64_t;  // steady clock, nanoseconds

/// One camera at one instant.
struct Picture {
  Image<Rgb8> pixels;
  TimeNs t_ns = 0;
  std::uint64_t sequence = 0;
  std::vector<std::uint8_t> jpeg = {};  // the same as its camera or file delivered it; empty where that was no JPEG
  int coding_noise_q4 = 0;  // what coding it as a JPEG left in its brightness, sigma in 1/16 levels; 0: none, or not known
};

/// Both cameras at one instant; the pictures have the same size.
struct Pair {
  Picture left, right;
  std::uint64_t sequence = 0;
};

/// Where a disparity came from.
enum class Origin : std::uint8_t { kNone = 0, kMeasured = 1, kFilled = 2 };

/// Disparity d = x_left - x_right >= 0 of each pixel of the left picture.
///
/// Shape   both images H x W
/// Units   d_q4 in 1/16 px; kNone where nothing is known
struct Disparity {
  static constexpr std::uint16_t kNone = 0xFFFF;  // not 0: 0 is a point at infinity
  Image<std::uint16_t> d_q4;
  Image<std::uint8_t> origin;  // Origin of each pixel; kNone exactly where d_q4 is kNone
};

/// Time that one stage took, summed over its calls in this frame.
struct StageTime {
  const char* stage = "";
  std::int64_t wall_ns = 0;
  std::int64_t cpu_ns = 0;  // of the whole process
};

/// Of a frame whose left, color and disparity stay on the device that made them: a handle for trackers that have kernels of
/// their own (want: on_device).
class DeviceMaps {
 public:
  virtual ~DeviceMaps() = default;
};

/// All that is known of one instant; const once the engine has published it.
///
/// Shape   every map H x W of the rectified pair; maps that were not wanted are empty
struct Frame {
  std::uint64_t sequence = 0;
  TimeNs t_ns = 0;                                // of the left picture
  TimeNs skew_ns = 0;                             // how much later the right picture was taken
  Image<std::uint8_t> left, right;                // rectified, gray, denoised: what the matcher saw
  Image<std::uint8_t> left_inside, right_inside;  // 255 where the raw picture covers the pixel, 0 outside; empty = all inside
  Image<Rgb8> color;                              // rectified left picture (want: color)
  Disparity disparity;
  Window matched = {};                 // what was matched, where that is not all (see Engine::focus()); empty: all
  Image<std::uint8_t> confidence;      // 1 (doubtful) .. 255 (sure) where measured, else 0 (want: confidence)
  Image<std::uint16_t> depth_mm;       // z in the rig frame, 0 = none (want: depth; needs a rig)
  DeviceMaps* on_device = nullptr;     // valid as long as the frame (want: on_device); null on the CPU
  std::array<StageTime, 24> stages{};  // when asked for; ends at the first with wall_ns 0
};

}  // namespace duo
