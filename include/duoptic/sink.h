// Writing what was found. A file appears whole under its name, or not at all: the functions write one file a call, a Sink takes
// frame after frame and gives its file the name at the end.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "duoptic/axes.h"
#include "duoptic/frame.h"
#include "duoptic/result.h"
#include "duoptic/rig.h"
#include "duoptic/tracker.h"

namespace [[gnu::visibility("default")]] duo {

inline constexpr double kNoFarLimit_m = 1e9;

/// Disparity as a PFM of float px, +infinity where there is none (Middlebury's convention).
Result<void> write_pfm(View<const std::uint16_t> d_q4, const std::filesystem::path& path);
/// Reads a one-channel PFM, either byte order; rows top to bottom.
Result<Image<float>> read_pfm(const std::filesystem::path& path);
/// The same for bytes already in memory; `name` stands for them in messages.
Result<Image<float>> parse_pfm(std::string_view bytes, const std::string& name);

Result<void> write_png(View<const Rgb8> picture, const std::filesystem::path& path);
Result<void> write_png(View<const std::uint8_t> picture, const std::filesystem::path& path);
Result<void> write_png(View<const std::uint16_t> picture, const std::filesystem::path& path);

struct CloudOptions {
  Axes axes = Axes::kOpencv;
  double far_m = kNoFarLimit_m;  // points that lie farther along z of the rig frame are left out
  bool metric = true;            // as Rig::metric: whether the file may say metres
};

/// Coloured points of all pixels with a depth, in metres: binary little-endian PLY, x y z float, red green blue uchar.
Result<void> write_ply(View<const std::uint16_t> d_q4, View<const Rgb8> color, const Rectified& rectified,
                       const std::filesystem::path& path, const CloudOptions& options = {});

/// What sinks are told before the first frame.
struct TrackHeader {
  std::vector<std::string> sources;  // as the user named them, left first
  std::string engine, device, matcher, matcher_preset, tracker;
  std::vector<const Skeleton*> skeletons;  // that persons may have
  Rectified rectified;
  Size size;  // of the raw left picture
  double frame_s = 1.0 / 30;
  bool live = false;   // from cameras: what differs from run to run is told, too
  bool metric = true;  // as Rig::metric
  bool focus = false;  // frames are matched around people alone
};

struct TrackTimes {
  double engine_ms = 0, tracker_ms = 0;
};

/// One instant. `left` and `frame` may be kept by sinks that want pictures; `people`, and what others get in place of both,
/// live until write() returns.
struct TrackedFrame {
  std::int64_t number = 0;              // from 0, of the source
  double t_s = 0;                       // since the source's first picture
  std::shared_ptr<const Picture> left;  // raw
  std::shared_ptr<const Frame> frame;   // with disparity and colour
  std::span<const Person> people;
  std::optional<TrackTimes> times;  // written only when given, because they differ from run to run
};

/// Takes the frames of one run in their order.
class Sink {
 public:
  virtual ~Sink() = default;
  virtual Result<void> write(const TrackedFrame& frame) = 0;
  /// Whether write() looks at TrackedFrame::left and ::frame.
  virtual bool wants_pictures() const { return false; }
  /// Whether write() always returns at once, whatever happens to what it sends.
  virtual bool instant() const { return false; }
  /// Writes what waits for later frames.
  virtual Result<void> flush() { return {}; }
  /// Frames that were not written or sent because the last one took too long.
  virtual std::int64_t dropped() const { return 0; }
  /// Ends the file and gives it its name; without it nothing is left.
  virtual Result<void> finish() = 0;
};

/// JSON lines: a header, then a line per frame (see docs/json_lines.md). An empty `path` is stdout.
///
/// Errors  those of every written file
Result<std::unique_ptr<Sink>> make_json_lines(const std::filesystem::path& path, const TrackHeader& header);

/// The four panels of duoptic/paint.h as H.264 in MP4, 4:2:0, which plays everywhere; MPEG-4 part 2 where this machine's libav
/// has no H.264 encoder, which `note` then says.
///
/// Errors  those of every written file; no encoder at all
Result<std::unique_ptr<Sink>> make_panel_video(const std::filesystem::path& path, const TrackHeader& header, std::string& note);

/// A row per frame, person and joint, see docs/formats.md.
///
/// Errors  those of every written file
Result<std::unique_ptr<Sink>> make_csv(const std::filesystem::path& path, Axes axes);

/// Motion for animation programs: a hierarchy per person, with the median length of its bones, and a line of channels each
/// frame_s from the first frame on. Metres, y up, see docs/formats.md. Kept in memory until finish(), some 30 bytes per person,
/// joint and frame.
///
/// Errors  those of every written file
Result<std::unique_ptr<Sink>> make_bvh(const std::filesystem::path& path, const TrackHeader& header);

/// The same as a binary glTF 2.0: a node per joint, a skin and an animation per person.
///
/// Errors  those of every written file
Result<std::unique_ptr<Sink>> make_gltf(const std::filesystem::path& path, const TrackHeader& header);

/// Places of the joints as markers, for OpenSim and other programs of biomechanics: a row each frame_s from the first frame on.
/// Metres, y up, nothing where a joint is lost, see docs/formats.md. Kept in memory until finish().
///
/// Errors  those of every written file
Result<std::unique_ptr<Sink>> make_trc(const std::filesystem::path& path, const TrackHeader& header);

/// Depth, its camera, coloured points and people as messages of ROS 2 in an MCAP file, see docs/formats.md. Frames need
/// disparity and colour.
///
/// Errors  those of every written file
Result<std::unique_ptr<Sink>> make_mcap(const std::filesystem::path& path, const TrackHeader& header);

/// Sends a bundle of OSC messages a frame by UDP to `target`, "host:port"; nothing listens and nothing waits: what the network
/// does not take at once is dropped. See docs/formats.md for the addresses.
///
/// Errors  not host:port, no such host
Result<std::unique_ptr<Sink>> make_osc(const std::string& target, Axes axes);

/// The same with the Virtual Motion Capture protocol: bones of a humanoid avatar as rotations from its T-pose. Of two persons
/// with the same skeleton the first is sent.
enum class VmcBones : std::uint8_t {
  kWhole,     // each bone lies as far from its parent as in the first pose that was known
  kRotations  // positions are 0: for receivers that keep the avatar's own bones
};
Result<std::unique_ptr<Sink>> make_vmc(const std::string& target, VmcBones bones = VmcBones::kWhole);

/// `sink` behind a thread and a queue, for live sources: write() returns at once. The queue has room for
/// two seconds of poses, or for four frames with their pictures; when it is full the oldest frame in it goes, and dropped()
/// counts. Errors of `sink` come with the next call.
///
/// Errors  the system gives no thread
Result<std::unique_ptr<Sink>> in_background(std::unique_ptr<Sink> sink);

}  // namespace duo
