// The files that a frame becomes: maps, points, and the camera that they are of.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "duoptic/frame.h"
#include "duoptic/result.h"
#include "duoptic/rig.h"
#include "duoptic/sink.h"

namespace [[gnu::visibility("default")]] duo {

/// Kinds of output, as a user names them. All but disparity and confidence need a rig.
enum class FrameOutput : std::uint8_t {
  kDisparity,   // disparity.pfm, disparity.png
  kDepth,       // depth.png
  kCloud,       // cloud.ply
  kPicture,     // left_rectified.png
  kCamera,      // camera.json
  kConfidence,  // confidence.png
  kDepthVideo   // of all frames: depth.mkv
};
inline constexpr std::array<std::string_view, 7> kFrameOutputNames = {"disparity", "depth",      "cloud",      "picture",
                                                                      "camera",    "confidence", "depth-video"};

/// What of a frame is written, and how.
struct FrameFiles {
  std::vector<FrameOutput> outputs = {FrameOutput::kDisparity, FrameOutput::kDepth, FrameOutput::kCloud, FrameOutput::kPicture,
                                      FrameOutput::kCamera};  // those that need a rig only where there is one
  CloudOptions cloud = {};        // its far_m holds for depth, too; where nothing is metric no file says so
  double disparity_sigma_px = 0;  // of the rig, see RigFit
  bool has(FrameOutput output) const;
};

/// The names of all files that write_frame() may write.
std::vector<std::string> frame_file_names();

/// Writes the files of a frame. `place` tells where to write the file of that name. The maps that are asked for must be in the
/// frame.
///
/// Errors  those of every written file
Result<void> write_frame(const Frame& frame, const std::optional<Rectified>& rectified, const FrameFiles& files,
                         const std::function<std::filesystem::path(const std::string& name)>& place);

/// The depth with nothing farther than `far_m`; mm, 0 = none.
Image<std::uint16_t> near_depth(const Image<std::uint16_t>& depth_mm, double far_m);

/// The camera that the rectified left picture, its depth and its disparity are of, as JSON: docs/formats.md has the fields.
std::string camera_json(const Rectified& rectified, bool metric, double disparity_sigma_px);

/// Depth of all frames as one video: FFV1 of 16 bits gray in Matroska, nothing lost; mm, 0 = none. With the time of each frame.
class DepthVideo {
 public:
  /// Errors  no encoder for it; those of every written file
  static Result<DepthVideo> open(const std::filesystem::path& path, Size size, double frame_s);
  DepthVideo(DepthVideo&&) noexcept;
  DepthVideo& operator=(DepthVideo&&) noexcept;
  ~DepthVideo();
  /// Errors  those of every written file
  Result<void> write(View<const std::uint16_t> depth_mm, double t_s);
  /// Gives the file its name; without it nothing is left.
  Result<void> finish();

 private:
  struct State;
  explicit DepthVideo(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace duo
