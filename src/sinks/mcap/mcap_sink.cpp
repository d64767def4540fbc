// Frames and people as robots have them: messages of ROS 2 in an MCAP file.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/point.h"
#include "duoptic/sink.h"
#include "sinks/mcap/cdr.h"
#include "sinks/mcap/mcap_file.h"
#include "sinks/mcap/ros_schemas.h"

namespace duo {
namespace {

constexpr std::string_view kRigFrame = "duoptic_left";  // an optical frame: x right, y down, z forward

void put_time(Cdr& out, double t_s) {
  const auto ns = std::llround(t_s * 1e9);
  out.put(static_cast<std::int32_t>(ns / 1'000'000'000)).put(static_cast<std::uint32_t>(ns % 1'000'000'000));
}
void put_header(Cdr& out, double t_s) {
  put_time(out, t_s);
  out.text(kRigFrame);
}
void put_point(Cdr& out, Vec3 p) { out.put(p.x).put(p.y).put(p.z); }
void put_color(Cdr& out, JointState state) {
  const bool seen = state == JointState::kSeen;
  out.put(seen ? 0.2F : 1.0F).put(seen ? 0.9F : 0.6F).put(0.2F).put(1.0F);
}

/// 32FC1: metres, NaN where nothing is known.
std::string image_of(const TrackedFrame& frame, const Rectified& rectified) {
  const Image<std::uint16_t>& d_q4 = frame.frame->disparity.d_q4;
  Cdr out;
  put_header(out, frame.t_s);
  const auto width = static_cast<std::uint32_t>(d_q4.width()), height = static_cast<std::uint32_t>(d_q4.height());
  out.put(height).put(width).text("32FC1").put(std::uint8_t{0}).put(4 * width).count(std::size_t{4} * width * height);
  std::vector<float> row(width);
  for (int y = 0; y < d_q4.height(); ++y) {
    for (int x = 0; x < d_q4.width(); ++x) {
      const auto p_m = point_at(d_q4, rectified, y, x);
      row[static_cast<std::size_t>(x)] = p_m ? static_cast<float>(p_m->z) : std::numeric_limits<float>::quiet_NaN();
    }
    out.raw(row.data(), row.size() * sizeof(float));
  }
  return out.bytes();
}

/// Of the rectified left picture: no distortion.
std::string camera_of(const TrackedFrame& frame, const Rectified& r) {
  Cdr out;
  put_header(out, frame.t_s);
  out.put(static_cast<std::uint32_t>(r.size.height)).put(static_cast<std::uint32_t>(r.size.width)).text("plumb_bob").count(5);
  for (int i = 0; i < 5; ++i) out.put(0.0);
  for (const double k : {r.focal_px, 0.0, r.cx_px, 0.0, r.focal_px, r.cy_px, 0.0, 0.0, 1.0}) out.put(k);
  for (const double one : Mat3().m) out.put(one);
  for (const double p : {r.focal_px, 0.0, r.cx_px, 0.0, 0.0, r.focal_px, r.cy_px, 0.0, 0.0, 0.0, 1.0, 0.0}) out.put(p);
  for (int i = 0; i < 6; ++i) out.put(std::uint32_t{0});  // no binning, no region
  out.put(std::uint8_t{0});
  return out.bytes();
}

/// Points of all pixels with a disparity, in colour.
std::string cloud_of(const TrackedFrame& frame, const Rectified& rectified) {
  constexpr std::uint8_t kFloat32 = 7;
  constexpr std::array<const char*, 4> kFields = {"x", "y", "z", "rgb"};
  const Image<std::uint16_t>& d_q4 = frame.frame->disparity.d_q4;
  const Image<Rgb8>& color = frame.frame->color;
  std::string points;
  for (int y = 0; y < d_q4.height(); ++y)
    for (int x = 0; x < d_q4.width(); ++x)
      if (const auto p_m = point_at(d_q4, rectified, y, x)) {
        const Rgb8 c = color.at(y, x);
        const std::array<float, 3> xyz = {static_cast<float>(p_m->x), static_cast<float>(p_m->y), static_cast<float>(p_m->z)};
        const std::array<std::uint8_t, 4> bgr0 = {c.b, c.g, c.r, 0};
        points.append(reinterpret_cast<const char*>(xyz.data()), sizeof(xyz));
        points.append(reinterpret_cast<const char*>(bgr0.data()), sizeof(bgr0));
      }
  Cdr out;
  put_header(out, frame.t_s);
  const auto bytes = static_cast<std::uint32_t>(points.size());
  out.put(std::uint32_t{1}).put(bytes / 16).count(kFields.size());
  for (std::uint32_t i = 0; i < kFields.size(); ++i) out.text(kFields[i]).put(4 * i).put(kFloat32).put(std::uint32_t{1});
  out.put(std::uint8_t{0}).put(std::uint32_t{16}).put(bytes).count(points.size()).raw(points.data(), points.size());
  out.put(std::uint8_t{1});  // no point is NaN
  return out.bytes();
}

/// A frame of its own per joint that is not lost: "person_1/right_hand".
std::string transforms_of(const TrackedFrame& frame) {
  std::size_t count = 0;
  for (const Person& person : frame.people)
    for (std::size_t j = 0; j < person.count(); ++j) count += person.joints[j].state != JointState::kLost;
  Cdr out;
  out.count(count);
  for (const Person& person : frame.people)
    for (std::size_t j = 0; j < person.count(); ++j) {
      const Joint& joint = person.joints[j];
      if (joint.state == JointState::kLost) continue;
      put_header(out, frame.t_s);
      out.text(fmt::format("person_{}/{}", person.id, person.skeleton->joints[j].name));
      put_point(out, joint.p_in_rig_m);
      const Quaternion turn = joint.has_turn ? joint.rig_from_bone : Quaternion();
      out.put(double{turn.x}).put(double{turn.y}).put(double{turn.z}).put(double{turn.w});
    }
  return out.bytes();
}

/// Of each person a list of bones and one of joints, both in the joints' colours.
void put_marker(Cdr& out, const TrackedFrame& frame, const Person& person, bool bones) {
  constexpr std::int32_t kLineList = 5, kSphereList = 7;
  constexpr std::uint32_t kLifetime_ns = 200'000'000;  // who is no longer there vanishes
  std::vector<std::size_t> joints;
  for (std::size_t j = 0; j < person.count(); ++j) {
    const int parent = person.skeleton->joints[j].parent;
    const auto known = [&](std::size_t at) { return person.joints[at].state != JointState::kLost; };
    if (!bones && known(j)) joints.push_back(j);
    if (bones && parent >= 0 && known(j) && known(static_cast<std::size_t>(parent)))
      joints.insert(joints.end(), {static_cast<std::size_t>(parent), j});
  }
  put_header(out, frame.t_s);
  out.text(bones ? "bones" : "joints").put(static_cast<std::int32_t>(person.id));
  out.put(bones ? kLineList : kSphereList).put(std::int32_t{0});
  put_point(out, {});
  out.put(0.0).put(0.0).put(0.0).put(1.0);
  const double width_m = bones ? 0.01 : 0.04;
  put_point(out, {width_m, width_m, width_m});
  put_color(out, JointState::kSeen);
  out.put(std::int32_t{0}).put(kLifetime_ns).put(std::uint8_t{0}).count(joints.size());
  for (const std::size_t j : joints) put_point(out, person.joints[j].p_in_rig_m);
  out.count(joints.size());
  for (const std::size_t j : joints) put_color(out, person.joints[j].state);
  out.text("");  // no texture, in any of its fields
  put_time(out, 0);
  out.text("").text("").count(0).count(0);
  out.text("").text("").text("").count(0).put(std::uint8_t{0});  // no text, no mesh
}

std::string markers_of(const TrackedFrame& frame) {
  Cdr out;
  out.count(2 * frame.people.size());
  for (const Person& person : frame.people)
    for (const bool bones : {true, false}) put_marker(out, frame, person, bones);
  return out.bytes();
}

class Mcap final : public Sink {
 public:
  Mcap(McapFile file, const Rectified& rectified) : file_(std::move(file)), rectified_(rectified) {
    using namespace ros;  // NOLINT: names of messages
    image_ = file_.add_channel("/duoptic/depth/image", "sensor_msgs/msg/Image", with(kImage, kHeader, kTime));
    camera_ = file_.add_channel("/duoptic/depth/camera_info", "sensor_msgs/msg/CameraInfo",
                                with(kCameraInfo, kHeader, kTime, kRegion));
    cloud_ = file_.add_channel("/duoptic/points", "sensor_msgs/msg/PointCloud2", with(kCloud, kHeader, kTime, kField));
    transforms_ = file_.add_channel("/tf", "tf2_msgs/msg/TFMessage",
                                    with("geometry_msgs/TransformStamped[] transforms\n", kTransformStamped, kHeader, kTime,
                                         kTransform, kVector3, kQuaternion));
    markers_ = file_.add_channel("/duoptic/people", "visualization_msgs/msg/MarkerArray",
                                 with("visualization_msgs/Marker[] markers\n", kMarker, kHeader, kTime, kDuration, kPose,
                                      kPoint, kQuaternion, kVector3, kColor, kCompressedImage, kUv, kMesh));
  }

  Result<void> write(const TrackedFrame& frame) override {
    const auto t_ns = static_cast<std::uint64_t>(std::llround(frame.t_s * 1e9));
    file_.add_message(image_, t_ns, image_of(frame, rectified_));
    file_.add_message(camera_, t_ns, camera_of(frame, rectified_));
    file_.add_message(cloud_, t_ns, cloud_of(frame, rectified_));
    file_.add_message(transforms_, t_ns, transforms_of(frame));
    file_.add_message(markers_, t_ns, markers_of(frame));
    return file_.end_chunk();
  }
  bool wants_pictures() const override { return true; }
  Result<void> finish() override { return file_.finish(); }

 private:
  McapFile file_;
  Rectified rectified_;
  std::uint16_t image_ = 0, camera_ = 0, cloud_ = 0, transforms_ = 0, markers_ = 0;
};

}  // namespace

Result<std::unique_ptr<Sink>> make_mcap(const std::filesystem::path& path, const TrackHeader& header) {
  DUO_TRY_ASSIGN(McapFile file, McapFile::open(path, "ros2"));
  return std::unique_ptr<Sink>(std::make_unique<Mcap>(std::move(file), header.rectified));
}

}  // namespace duo
