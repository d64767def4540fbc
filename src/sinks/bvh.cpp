#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/file.h"
#include "duoptic/sink.h"
#include "sinks/arm_bones.h"
#include "sinks/joint_text.h"

namespace duo {
namespace {

/// Where the joints of one arm are, y up; empty while one of them is lost.
using KnownArm = std::optional<std::array<Vec3, kArmJoints>>;

KnownArm known_arm(const ArmPose& pose) {
  std::array<Vec3, kArmJoints> out;
  for (std::size_t j = 0; j < kArmJoints; ++j) {
    if (pose.joints[j].state == JointState::kLost) return std::nullopt;
    out[j] = axes_from_rig(Axes::kOpengl) * pose.joints[j].p_in_rig_m;
  }
  return out;
}

Vec3 at(const std::array<Vec3, kArmJoints>& arm, Joint joint) { return arm[static_cast<std::size_t>(joint)]; }

/// Degrees around z, x, y so that rotation = Rz Rx Ry, the order in which the channels stand.
std::array<double, 3> zxy_degrees(const Mat3& r) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  const double x = std::asin(std::clamp(r(2, 1), -1.0, 1.0));
  const bool locked = std::abs(r(2, 1)) > 1 - 1e-12;  // z and y turn around the same axis: all of it is z's
  const double z = locked ? std::atan2(r(1, 0), r(0, 0)) : std::atan2(-r(0, 1), r(1, 1));
  const double y = locked ? 0 : std::atan2(-r(2, 0), r(2, 2));
  return {z * kDegrees, x * kDegrees, y * kDegrees};
}

std::string channels(const Mat3& rotation) {
  const auto angles = zxy_degrees(rotation);
  return fmt::format("{} {} {}", number(angles[0], 6), number(angles[1], 6), number(angles[2], 6));
}

/// One arm through all frames.
class Track {
 public:
  explicit Track(ArmSide side) : side_(side) {}
  /// Frame `slot`; those that were left out hold the one before, as those do in which a joint is lost.
  void add(std::size_t slot, const KnownArm& arm) {
    frames_.resize(std::max(frames_.size(), slot + 1));
    frames_[slot] = arm;
  }
  std::string hierarchy() const;
  /// Six numbers of the shoulder, three of the elbow and three of the hand, for each of `count` frames.
  std::vector<std::string> motion(std::size_t count) const;

 private:
  double median_length_m(Joint from, Joint to, double otherwise_m) const;

  ArmSide side_;
  std::vector<KnownArm> frames_;
};

double Track::median_length_m(Joint from, Joint to, double otherwise_m) const {
  std::vector<double> lengths_m;
  for (const KnownArm& arm : frames_)
    if (arm) lengths_m.push_back(norm(at(*arm, to) - at(*arm, from)));
  if (lengths_m.empty()) return otherwise_m;
  const auto middle = lengths_m.begin() + static_cast<std::ptrdiff_t>(lengths_m.size() / 2);
  std::nth_element(lengths_m.begin(), middle, lengths_m.end());
  return *middle;
}

std::string Track::hierarchy() const {
  constexpr double kUpper_m = 0.3, kLower_m = 0.25, kFingers_m = 0.1;  // an adult's, where nothing was seen
  const double x = rest_x(side_, false);
  const auto offset = [&](double length_m) { return fmt::format("OFFSET {} 0.000000 0.000000", number(x * length_m, 6)); };
  const std::string_view name = side_name(side_);
  return fmt::format(
      "ROOT {0}Arm\n{{\n\tOFFSET 0.000000 0.000000 0.000000\n"
      "\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
      "\tJOINT {0}ForeArm\n\t{{\n\t\t{1}\n\t\tCHANNELS 3 Zrotation Xrotation Yrotation\n"
      "\t\tJOINT {0}Hand\n\t\t{{\n\t\t\t{2}\n\t\t\tCHANNELS 3 Zrotation Xrotation Yrotation\n"
      "\t\t\tEnd Site\n\t\t\t{{\n\t\t\t\t{3}\n\t\t\t}}\n\t\t}}\n\t}}\n}}\n",
      name, offset(median_length_m(Joint::kShoulder, Joint::kElbow, kUpper_m)),
      offset(median_length_m(Joint::kElbow, Joint::kHand, kLower_m)), offset(kFingers_m));
}

std::vector<std::string> Track::motion(std::size_t count) const {
  ArmTurner turner(rest_x(side_, false));
  std::vector<std::string> lines(count);
  std::string last;
  std::size_t first_known = count;
  for (std::size_t i = 0; i < count; ++i) {
    const KnownArm arm = i < frames_.size() ? frames_[i] : std::nullopt;
    const auto turns =
        arm ? turner.turn(at(*arm, Joint::kShoulder), at(*arm, Joint::kElbow), at(*arm, Joint::kHand)) : std::nullopt;
    if (turns) {
      const Vec3 p_m = at(*arm, Joint::kShoulder);
      last = fmt::format("{} {} {} {} {} {}", number(p_m.x, 6), number(p_m.y, 6), number(p_m.z, 6), channels(turns->upper),
                         channels(turns->lower), channels(Mat3{}));
      first_known = std::min(first_known, i);
    }
    lines[i] = last;
  }
  // Before the arm was known first it is where it was then.
  const std::string rest = fmt::format("0.000000 0.000000 0.000000 {0} {0} {0}", channels(Mat3{}));
  std::fill_n(lines.begin(), first_known, first_known < count ? lines[first_known] : rest);
  return lines;
}

class Bvh final : public Sink {
 public:
  Bvh(PartialFile file, const TrackHeader& header)
      : file_(std::move(file)), first_arm_(header.first_arm), frame_s_(header.frame_s) {}

  Result<void> write(const TrackedFrame& frame) override {
    if (tracks_.empty()) start_s_ = frame.t_s;
    while (tracks_.size() < std::max<std::size_t>(frame.arms.size(), 1))
      tracks_.emplace_back(side_of(first_arm_, tracks_.size()));
    // A live source may have left frames out; the file has one each frame_s.
    const auto slot = static_cast<std::size_t>(std::max<long long>(std::llround((frame.t_s - start_s_) / frame_s_), 0));
    count_ = std::max(count_, slot + 1);
    for (std::size_t arm = 0; arm < frame.arms.size(); ++arm) tracks_[arm].add(slot, known_arm(frame.arms[arm]));
    return {};
  }

  Result<void> finish() override {
    std::string text = "HIERARCHY\n";
    for (const Track& track : tracks_) text += track.hierarchy();
    text += fmt::format("MOTION\nFrames: {}\nFrame Time: {}\n", count_, number(frame_s_, 8));
    std::vector<std::vector<std::string>> arms;
    for (const Track& track : tracks_) arms.push_back(track.motion(count_));
    for (std::size_t i = 0; i < count_; ++i)
      for (std::size_t arm = 0; arm < arms.size(); ++arm) text += arms[arm][i] + (arm + 1 < arms.size() ? " " : "\n");
    DUO_TRY(file_.write(text));
    return file_.publish();
  }

 private:
  PartialFile file_;
  ArmSide first_arm_;
  double frame_s_, start_s_ = 0;
  std::vector<Track> tracks_;
  std::size_t count_ = 0;
};

}  // namespace

Result<std::unique_ptr<Sink>> make_bvh(const std::filesystem::path& path, const TrackHeader& header) {
  DUO_TRY_ASSIGN(PartialFile file, PartialFile::open(path));
  return std::unique_ptr<Sink>(std::make_unique<Bvh>(std::move(file), header));
}

}  // namespace duo
