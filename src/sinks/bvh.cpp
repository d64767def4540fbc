#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/file.h"
#include "duoptic/sink.h"
#include "sinks/motion_tracks.h"
#include "sinks/text_values.h"

namespace duo {
namespace {

/// Degrees around z, x, y so that rotation = Rz Rx Ry, the order in which the channels stand.
std::array<double, 3> zxy_degrees(const Mat3& r) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  const double x = std::asin(std::clamp(r(2, 1), -1.0, 1.0));
  const bool locked = std::abs(r(2, 1)) > 1 - 1e-12;  // z and y turn around the same axis: all of it is z's
  const double z = locked ? std::atan2(r(1, 0), r(0, 0)) : std::atan2(-r(0, 1), r(1, 1));
  const double y = locked ? 0 : std::atan2(-r(2, 0), r(2, 2));
  return {z * kDegrees, x * kDegrees, y * kDegrees};
}

std::string offset_text(Vec3 v) { return fmt::format("OFFSET {} {} {}", number(v.x, 6), number(v.y, 6), number(v.z, 6)); }

/// The joint and all that hangs from it.
std::string hierarchy(const MotionTrack& track, std::size_t joint, int depth) {
  // Fingers, toes, the top of the head; beyond the tip of a finger its nail.
  const double end_m = is_finger(track.skeleton().joints[joint].id) ? 0.005 : 0.1;
  const std::string tabs(static_cast<std::size_t>(depth), '\t');
  const bool root = depth == 0;
  std::string out =
      fmt::format("{0}{1} {2}\n{0}{{\n{0}\t{3}\n{0}\tCHANNELS {4}Zrotation Xrotation Yrotation\n", tabs,
                  root ? "ROOT" : "JOINT", track.joint_name(joint), offset_text(root ? Vec3{} : track.offset_m(joint)),
                  root ? "6 Xposition Yposition Zposition " : "3 ");
  for (const std::size_t child : track.children(joint)) out += hierarchy(track, child, depth + 1);
  if (track.children(joint).empty()) {
    const Vec3 end = end_m * rest_direction(track.skeleton().joints[joint].id, BodyAxes::kRightHanded);
    out += fmt::format("{0}\tEnd Site\n{0}\t{{\n{0}\t\t{1}\n{0}\t}}\n", tabs, offset_text(end));
  }
  return out + tabs + "}\n";
}

/// Of the joint and all that hangs from it, in the order of hierarchy().
void append_channels(const MotionTrack& track, const std::vector<Mat3>& turns, std::size_t joint, std::string& line) {
  const auto angles = zxy_degrees(turns[joint]);
  line += fmt::format(" {} {} {}", number(angles[0], 6), number(angles[1], 6), number(angles[2], 6));
  for (const std::size_t child : track.children(joint)) append_channels(track, turns, child, line);
}

std::string motion_line(const MotionTrack& track, const MotionTrack::Pose& pose) {
  std::string out = fmt::format("{} {} {}", number(pose.root_m.x, 6), number(pose.root_m.y, 6), number(pose.root_m.z, 6));
  append_channels(track, pose.turns, 0, out);
  return out;
}

class Bvh final : public Sink {
 public:
  Bvh(PartialFile file, const TrackHeader& header) : file_(std::move(file)), tracks_(header) {}

  Result<void> write(const TrackedFrame& frame) override {
    tracks_.add(frame);
    return {};
  }

  Result<void> finish() override {
    std::string text = "HIERARCHY\n";
    std::vector<std::vector<MotionTrack::Pose>> poses;
    const auto& tracks = tracks_.finished();
    for (const MotionTrack& track : tracks) {
      text += hierarchy(track, 0, 0);
      poses.push_back(track.poses(tracks_.count()));
    }
    text += fmt::format("MOTION\nFrames: {}\nFrame Time: {}\n", tracks_.count(), number(tracks_.frame_s(), 8));
    for (std::size_t i = 0; i < tracks_.count(); ++i)
      for (std::size_t n = 0; n < tracks.size(); ++n)
        text += motion_line(tracks[n], poses[n][i]) + (n + 1 < tracks.size() ? " " : "\n");
    DUO_TRY(file_.write(text));
    return file_.publish();
  }

 private:
  PartialFile file_;
  MotionTracks tracks_;
};

}  // namespace

Result<std::unique_ptr<Sink>> make_bvh(const std::filesystem::path& path, const TrackHeader& header) {
  DUO_TRY_ASSIGN(PartialFile file, PartialFile::open(path));
  return std::unique_ptr<Sink>(std::make_unique<Bvh>(std::move(file), header));
}

}  // namespace duo
