// Synthetic clips as folders: videos, the true rig, the truth of every frame, and depth.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <system_error>

#include "calib/opencv_rectified.h"
#include "calib/rectification.h"
#include "core/file.h"
#include "core/json_text.h"
#include "duoptic/sink.h"
#include "duoptic/synthetic.h"
#include "sinks/clip/avi.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kFramesPerSecond = 30, kJpegQuality = 88, kDepthEvery = 10;

Error cannot_write(const fs::path& path, const std::string& why) {
  return {ErrorCode::kWriteFailed, fmt::format("cannot write clip '{}': {}", path.string(), why)};
}

/// A folder beside the final one, which takes its name in publish() and is gone before that. Both are looked up once.
class Staging {
 public:
  static Result<Staging> open(const fs::path& folder) {
    std::error_code error;
    if (fs::exists(folder, error) && !is_replaceable(folder))
      return cannot_write(folder, "the name is taken by something that is no earlier clip; choose another");
    const fs::path full = fs::absolute(folder, error).lexically_normal();
    const fs::path last = full.has_filename() ? full : full.parent_path();
    fs::create_directories(last.parent_path(), error);
    if (error) return cannot_write(folder, error.message() + "; write elsewhere or change the permissions");
    Staging out(last);
    out.parent_ = Descriptor(::open(last.parent_path().c_str(), kFolder));
    std::string name = path_in(out.parent_, ".duoptic-clip-XXXXXX").string();
    if (!out.parent_.is_open() || mkdtemp(name.data()) == nullptr)
      return cannot_write(folder, std::string(std::strerror(errno)) + "; write elsewhere or change the permissions");
    out.staged_ = fs::path(name).filename();
    out.inside_ = Descriptor(::openat(out.parent_.get(), out.staged_.c_str(), kFolder | O_NOFOLLOW));
    if (!out.inside_.is_open() || ::fchmod(out.inside_.get(), 0755) != 0) return cannot_write(folder, std::strerror(errno));
    return out;
  }
  Staging(Staging&& other) noexcept
      : folder_(std::move(other.folder_)),
        staged_(std::exchange(other.staged_, {})),
        parent_(std::move(other.parent_)),
        inside_(std::move(other.inside_)) {}
  ~Staging() {
    std::error_code ignored;
    if (!staged_.empty()) fs::remove_all(path_in(parent_, staged_), ignored);
  }

  fs::path operator/(const std::string& name) const { return path_in(inside_, name); }
  std::string name() const { return folder_.filename().string(); }

  /// An earlier clip goes where this one was, and with this object.
  Result<void> publish() {
    const std::string name = folder_.filename();
    const int in = parent_.get();
    if (std::error_code error; !fs::exists(path_in(parent_, name), error) && !error) {
      if (::renameat(in, staged_.c_str(), in, name.c_str()) != 0) return cannot_write(folder_, std::strerror(errno));
      staged_.clear();
      return {};
    }
    if (!is_replaceable(path_in(parent_, name))) return cannot_write(folder_, "the name was taken meanwhile; choose another");
    if (::renameat2(in, staged_.c_str(), in, name.c_str(), RENAME_EXCHANGE) == 0) return {};
    // A file system that cannot exchange two names.
    const std::string earlier = staged_ + "-earlier";
    if (errno != EINVAL || ::renameat(in, name.c_str(), in, earlier.c_str()) != 0)
      return cannot_write(folder_, std::strerror(errno));
    if (::renameat(in, staged_.c_str(), in, name.c_str()) == 0) {
      staged_ = earlier;
      return {};
    }
    const std::string why = std::strerror(errno);
    ::renameat(in, earlier.c_str(), in, name.c_str());
    return cannot_write(folder_, why);
  }

 private:
  static constexpr int kFolder = O_RDONLY | O_DIRECTORY | O_CLOEXEC;
  explicit Staging(fs::path folder) : folder_(std::move(folder)) {}

  /// An empty folder, or one with a clip and nothing else in it.
  static bool is_replaceable(const fs::path& folder) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) return false;
    constexpr std::array<std::string_view, 5> kParts = {"left.avi", "right.avi", "calibration_truth.yml", "truth.json",
                                                        "depth"};
    if (fs::is_empty(folder, error)) return true;
    if (!fs::exists(folder / "truth.json", error) || !fs::exists(folder / "left.avi", error)) return false;
    const auto entries = fs::directory_iterator(folder, error);
    return !error && std::all_of(begin(entries), end(entries), [&](const fs::directory_entry& entry) {
      return std::find(kParts.begin(), kParts.end(), entry.path().filename().native()) != kParts.end();
    });
  }

  fs::path folder_;
  std::string staged_;  // its name in the parent; empty: there is none any more
  Descriptor parent_, inside_;
};

// --- The truth -----------------------------------------------------------------------------------------------------------

double rounded(double v, double per_unit) { return std::round(v * per_unit) / per_unit; }

Json point(Vec3 p_m) { return {rounded(p_m.x, 1e5), rounded(p_m.y, 1e5), rounded(p_m.z, 1e5)}; }

Json pixel(const std::optional<std::array<double, 2>>& uv_px) {
  return uv_px ? Json{rounded((*uv_px)[0], 1e3), rounded((*uv_px)[1], 1e3)} : Json();
}

Json joints_of(const std::vector<SyntheticJoint>& joints, const Mat3& rig_from_left) {
  Json out = Json::object();
  for (const SyntheticJoint& joint : joints)
    out[std::string(name_of(joint.id))] = {
        {"xyz", point(joint.p_in_left_m)},
        {"xyz_rect", point(rig_from_left * joint.p_in_left_m)},
        {"uv_left", pixel(joint.uv_left_px)},
        {"uv_right", pixel(joint.uv_right_px)},
        {"in_left", joint.in_left},
        {"in_right", joint.in_right},
        {"vis_left", joint.visible_left},
        {"vis_right", joint.visible_right},
        {"surf_z_left", joint.surface_z_left_m ? Json(rounded(*joint.surface_z_left_m, 1e5)) : Json()}};
  return out;
}

Json truth_of(const SyntheticClipFrame& frame, int index, const Mat3& rig_from_left) {
  Json out = {{"frame", index},
              {"t", rounded(frame.t_s, 1e6)},
              {"light", {rounded(frame.ceiling_light, 1e4), 1.0, 1.0}},  // ceiling lamp, window, floor lamp
              {"joints", joints_of(frame.joints, rig_from_left)}};
  for (const auto& other : frame.others) out["others"].push_back({{"joints", joints_of(other, rig_from_left)}});
  return out;
}

Json meta_of(const SyntheticClipSetup& setup, const Rig& rig, const std::string& name, Json events) {
  Json tolerances = Json::object();
  using enum JointId;
  for (const JointId joint :
       {kLeftShoulder, kLeftElbow, kLeftWrist, kLeftHand, kLeftHip, kLeftKnee, kLeftAnkle, kLeftFoot, kHead, kNeck, kPelvis})
    tolerances[std::string(part_of(joint))] = SyntheticClip::tolerance_m(joint);
  return {{"clip", name},
          {"width", setup.size.width},
          {"height", setup.size.height},
          {"fps", kFramesPerSecond},
          {"frames", setup.frames},
          {"selected_arm", setup.arm == SyntheticArm::kLeft ? "left" : "right"},
          {"script", setup.script},
          {"seed", setup.seed},
          {"shutter_s", 0.0},
          {"skew_ms", setup.skew_s * 1e3},
          {"units", "metres"},
          {"frame_convention", "left camera: x right, y down, z forward"},
          {"baseline_m", rig.baseline_m()},
          {"events", std::move(events)},
          {"visible_tolerance_m", std::move(tolerances)},
          {"mjpeg_quality", kJpegQuality}};
}

// Depth in 0.1 mm; 0 where that does not fit 16 bits.
Image<std::uint16_t> in_tenths_mm(const Image<float>& depth_m) {
  Image<std::uint16_t> out(depth_m.size());
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const double tenths = depth_m.at(y, x) * 1e4 + 0.5;
      out.at(y, x) = tenths < 65536 ? static_cast<std::uint16_t>(tenths) : 0;
    }
  return out;
}

Result<void> write_depth(SyntheticClip& clip, int index, const Staging& out) {
  const SyntheticClip::Pinhole pinhole = clip.pinhole(index);
  DUO_TRY(write_png(in_tenths_mm(pinhole.depth_m), out / fmt::format("depth/depth_{:04}.png", index)));
  return write_png(pinhole.figure, out / fmt::format("depth/figure_{:04}.png", index));
}

Result<void> write_into(SyntheticClip& clip, const Staging& out, const std::function<bool(int, int)>& progress) {
  SyntheticClipSetup setup = clip.setup();
  DUO_TRY_ASSIGN(const Rectified rectified, rectified_geometry(clip.rig(), out.name()));
  DUO_TRY(write_file(out / "calibration_truth.yml", opencv_text(clip.rig(), opencv_rectified(rectified), true)));
  DUO_TRY_ASSIGN(AviWriter left, AviWriter::open(out / "left.avi", setup.size, kFramesPerSecond, kJpegQuality));
  DUO_TRY_ASSIGN(AviWriter right, AviWriter::open(out / "right.avi", setup.size, kFramesPerSecond, kJpegQuality));
  Json frames = Json::array(), events = Json::array();
  for (int i = 0; i < setup.frames; ++i) {
    const SyntheticClipFrame frame = clip.frame(i);
    DUO_TRY(left.write(frame.pair.left.pixels));
    DUO_TRY(right.write(frame.pair.right.pixels));
    if (i % kDepthEvery == 0) DUO_TRY(write_depth(clip, i, out));
    frames.push_back(truth_of(frame, i, rectified.rig_from_left));
    if (events.empty() || events.back()["what"] != frame.act)
      events.push_back({{"first", i}, {"last", i}, {"what", frame.act}});
    events.back()["last"] = i;
    if (progress && !progress(i + 1, setup.frames)) setup.frames = i + 1;
  }
  DUO_TRY(left.finish());
  DUO_TRY(right.finish());
  const Json truth = {{"meta", meta_of(setup, clip.rig(), out.name(), std::move(events))}, {"frames", std::move(frames)}};
  return write_file(out / "truth.json", json_text(truth, -1) + "\n");
}

}  // namespace

Result<void> write_clip(const SyntheticClipSetup& setup, const fs::path& folder, int threads,
                        const std::function<bool(int, int)>& progress) {
  DUO_TRY_ASSIGN(Staging out, Staging::open(folder));
  std::error_code error;
  if (!fs::create_directory(out / "depth", error)) return cannot_write(folder, error.message());
  DUO_TRY_ASSIGN(SyntheticClip clip, SyntheticClip::open(setup, threads));
  DUO_TRY(write_into(clip, out, progress));
  return out.publish();
}

}  // namespace duo
