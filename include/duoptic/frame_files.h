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

/// The files of a run of frames: those of one picture in the folder itself, of a video's frames in frame_000000 and so on below
/// it, the depth of all frames as one video, beside its camera. The files of a frame appear together or not at all, and take
/// the place of all files of an earlier run.
class FrameFolder {
 public:
  /// `still`: the frame of one picture comes. `asked`: files.outputs are what was asked for, not what is usual.
  ///
  /// Errors  an output that was asked for needs a rig, and there is none; a video of one picture
  static Result<FrameFolder> open(std::filesystem::path folder, FrameFiles files, bool asked,
                                  const std::optional<Rectified>& rectified, bool still, double frame_s);
  FrameFolder(FrameFolder&&) noexcept;
  ~FrameFolder();
  void set_disparity_sigma_px(double sigma_px);
  /// Errors  those of every written file
  Result<void> write(const std::shared_ptr<const Frame>& frame, std::uint64_t number, double t_s);
  /// Completes the video.
  Result<void> finish();
  const std::vector<std::string>& paths() const;  // that were written

 private:
  struct State;
  explicit FrameFolder(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Whether a limit of depth leaves anything.
class FarWatch {
 public:
  explicit FarWatch(double far_m) : far_m_(far_m) {}
  void see(const Image<std::uint16_t>& depth_mm);
  /// One line where almost all depth lies beyond the limit; else empty.
  std::string warning() const;

 private:
  double far_m_;
  std::vector<std::int64_t> pixels_;  // per depth, mm; 0: not known
};

}  // namespace duo
