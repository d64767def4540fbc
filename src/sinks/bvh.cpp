#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "body/bone_turns.h"
#include "core/file.h"
#include "duoptic/sink.h"
#include "duoptic/statistics.h"
#include "sinks/text_values.h"

namespace duo {
namespace {

/// What animation programs call the bone that begins at a joint.
constexpr std::array<std::string_view, kJointIds> kBoneNames = {
    "Hips",      "Spine",    "Chest",       "Neck",         "Head",       "LeftArm",   "LeftForeArm",
    "LeftWrist", "LeftHand", "RightArm",    "RightForeArm", "RightWrist", "RightHand", "LeftUpLeg",
    "LeftLeg",   "LeftFoot", "LeftToeBase", "RightUpLeg",   "RightLeg",   "RightFoot", "RightToeBase"};

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

/// One person through all frames.
class Track {
 public:
  /// `name_end`: what makes the names of its joints its own.
  Track(const Skeleton& skeleton, std::string name_end);

  /// Frame `slot`; those that were left out hold the one before, as those do in which a joint is lost.
  void add(std::size_t slot, const Person& person) {
    frames_.resize(std::max(frames_.size(), slot + 1));
    if (auto places = known_places(person, axes_from_rig(Axes::kOpengl))) frames_[slot] = std::move(*places);
  }
  const Skeleton& skeleton() const { return skeleton_; }
  std::string hierarchy() const { return node(0, 0); }
  /// Six numbers of the root and three of each other joint, in the order of hierarchy(), for each of `count` frames.
  std::vector<std::string> motion(std::size_t count) const;

 private:
  std::string node(std::size_t joint, int depth) const;
  Vec3 offset_m(std::size_t joint) const;
  std::string line(const Vec3& root_m, const std::vector<Mat3>& turns) const;
  void append_channels(std::size_t joint, const std::vector<Mat3>& turns, std::string& line) const;

  const Skeleton& skeleton_;
  std::string name_end_;
  std::vector<std::vector<std::size_t>> children_;
  std::vector<std::vector<Vec3>> frames_;  // places of the joints, y up; empty while one of them is lost
};

Track::Track(const Skeleton& skeleton, std::string name_end)
    : skeleton_(skeleton), name_end_(std::move(name_end)), children_(skeleton.joints.size()) {
  for (std::size_t j = 1; j < children_.size(); ++j)
    children_[static_cast<std::size_t>(skeleton.joints[j].parent)].push_back(j);
}

/// From the parent's joint at rest: as long as the median.
Vec3 Track::offset_m(std::size_t joint) const {
  constexpr double kUnseen_m = 0.25;
  const auto parent = static_cast<std::size_t>(skeleton_.joints[joint].parent);
  std::vector<double> lengths_m;
  for (const auto& places : frames_)
    if (!places.empty()) lengths_m.push_back(norm(places[joint] - places[parent]));
  const double length_m = lengths_m.empty() ? kUnseen_m : median(lengths_m);
  return length_m * rest_direction(skeleton_.joints[joint].id, BodyAxes::kRightHanded);
}

std::string Track::node(std::size_t joint, int depth) const {
  constexpr double kEnd_m = 0.1;  // fingers, toes, the top of the head
  const auto text = [](Vec3 v) { return fmt::format("OFFSET {} {} {}", number(v.x, 6), number(v.y, 6), number(v.z, 6)); };
  const std::string tabs(static_cast<std::size_t>(depth), '\t');
  const JointId id = skeleton_.joints[joint].id;
  const bool root = depth == 0;
  std::string out = fmt::format("{0}{1} {2}{3}\n{0}{{\n{0}\t{4}\n{0}\tCHANNELS {5}Zrotation Xrotation Yrotation\n", tabs,
                                root ? "ROOT" : "JOINT", kBoneNames[static_cast<std::size_t>(id)], name_end_,
                                text(root ? Vec3{} : offset_m(joint)), root ? "6 Xposition Yposition Zposition " : "3 ");
  for (const std::size_t child : children_[joint]) out += node(child, depth + 1);
  if (children_[joint].empty())
    out += fmt::format("{0}\tEnd Site\n{0}\t{{\n{0}\t\t{1}\n{0}\t}}\n", tabs,
                       text(kEnd_m * rest_direction(id, BodyAxes::kRightHanded)));
  return out + tabs + "}\n";
}

void Track::append_channels(std::size_t joint, const std::vector<Mat3>& turns, std::string& line) const {
  line += " " + channels(turns[joint]);
  for (const std::size_t child : children_[joint]) append_channels(child, turns, line);
}

std::string Track::line(const Vec3& root_m, const std::vector<Mat3>& turns) const {
  std::string out = fmt::format("{} {} {}", number(root_m.x, 6), number(root_m.y, 6), number(root_m.z, 6));
  append_channels(0, turns, out);
  return out;
}

std::vector<std::string> Track::motion(std::size_t count) const {
  BoneTurner turner(skeleton_, BodyAxes::kRightHanded);
  std::vector<std::string> lines(count);
  std::string last;
  std::size_t first_known = count;
  for (std::size_t i = 0; i < count; ++i) {
    const bool known = i < frames_.size() && !frames_[i].empty();
    if (const auto turns = known ? turner.turn(frames_[i]) : std::nullopt) {
      last = line(frames_[i][0], *turns);
      first_known = std::min(first_known, i);
    }
    lines[i] = last;
  }
  // Before the person was known first it is where it was then.
  const std::string rest = line({}, std::vector<Mat3>(children_.size()));
  std::fill_n(lines.begin(), first_known, first_known < count ? lines[first_known] : rest);
  return lines;
}

class Bvh final : public Sink {
 public:
  Bvh(PartialFile file, const TrackHeader& header)
      : file_(std::move(file)), skeletons_(header.skeletons), frame_s_(header.frame_s) {}

  Result<void> write(const TrackedFrame& frame) override {
    if (count_ == 0) start_s_ = frame.t_s;
    // A live source may have left frames out; the file has one each frame_s.
    const auto slot = static_cast<std::size_t>(std::max<long long>(std::llround((frame.t_s - start_s_) / frame_s_), 0));
    count_ = std::max(count_, slot + 1);
    for (const Person& person : frame.people)
      if (person.skeleton != nullptr) track_of(person).add(slot, person);
    return {};
  }

  Result<void> finish() override {
    if (tracks_.empty() && !skeletons_.empty()) tracks_.push_back({0, Track(*skeletons_[0], "")});  // a file needs a root
    std::string text = "HIERARCHY\n";
    std::vector<std::vector<std::string>> motions;
    for (const auto& [id, track] : tracks_) {
      text += track.hierarchy();
      motions.push_back(track.motion(count_));
    }
    text += fmt::format("MOTION\nFrames: {}\nFrame Time: {}\n", count_, number(frame_s_, 8));
    for (std::size_t i = 0; i < count_; ++i)
      for (std::size_t n = 0; n < motions.size(); ++n) text += motions[n][i] + (n + 1 < motions.size() ? " " : "\n");
    DUO_TRY(file_.write(text));
    return file_.publish();
  }

 private:
  Track& track_of(const Person& person) {
    bool same_names = false;
    for (auto& [id, track] : tracks_) {
      if (&track.skeleton() != person.skeleton) continue;
      if (id == person.id) return track;
      same_names = true;
    }
    return tracks_.emplace_back(person.id, Track(*person.skeleton, same_names ? fmt::format("_{}", person.id) : "")).second;
  }

  PartialFile file_;
  std::vector<const Skeleton*> skeletons_;
  double frame_s_, start_s_ = 0;
  std::vector<std::pair<std::uint32_t, Track>> tracks_;  // by the person's id, as they came
  std::size_t count_ = 0;
};

}  // namespace

Result<std::unique_ptr<Sink>> make_bvh(const std::filesystem::path& path, const TrackHeader& header) {
  DUO_TRY_ASSIGN(PartialFile file, PartialFile::open(path));
  return std::unique_ptr<Sink>(std::make_unique<Bvh>(std::move(file), header));
}

}  // namespace duo
