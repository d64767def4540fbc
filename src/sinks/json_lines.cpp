#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/file.h"
#include "core/json_text.h"
#include "duoptic/sink.h"
#include "duoptic/stdout.h"
#include "sinks/text_values.h"

namespace duo {
namespace {

constexpr int kVersion = 2;

std::string quoted(const std::string& text) {
  return json_text(nlohmann::json(text), -1);
}

/// From a live picture's capture to now.
double since_ms(TimeNs t_ns) {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return static_cast<double>(std::chrono::nanoseconds(now).count() - t_ns) * 1e-6;
}

const char* side_text(Side side) {
  constexpr const char* kSides[] = {"middle", "left", "right"};
  return kSides[static_cast<int>(side)];
}

/// The joints in order, parents first.
std::string skeleton_text(const Skeleton& skeleton) {
  std::vector<std::string> joints;
  for (const JointDef& joint : skeleton.joints) {
    const std::string parent =
        joint.parent < 0 ? "null" : fmt::format("\"{}\"", skeleton.joints[static_cast<std::size_t>(joint.parent)].name);
    joints.push_back(fmt::format(R"({{"id":{},"name":"{}","parent":{},"side":"{}"}})", static_cast<int>(joint.id), joint.name,
                                 parent, side_text(joint.side)));
  }
  return fmt::format(R"("{}":[{}])", skeleton.name, fmt::join(joints, ","));
}

std::string header_line(const TrackHeader& r) {
  std::vector<std::string> rotation, sources, skeletons;
  for (const double m : r.rectified.rig_from_left.m) rotation.push_back(number(m, 9));
  for (const std::string& source : r.sources) sources.push_back(quoted(source));
  for (const Skeleton* skeleton : r.skeletons) skeletons.push_back(skeleton_text(*skeleton));
  return fmt::format(
      R"({{"type":"header","version":{},"units":{{"length":"{}","time":"s","uv":"px of the raw left picture"}},)"
      R"("rig_from_left":[{}],"focal_px":{},"baseline_m":{},"sources":[{}],"engine":{},"device":{},"matcher":{},"matcher_preset":{},)"
      R"("tracker":{},{}"skeletons":{{{}}},"width":{},"height":{},"frame_s":{}}})"
      "\n",
      kVersion, r.metric ? "m" : "unknown", fmt::join(rotation, ","), number(r.rectified.focal_px, 4),
      number(r.rectified.baseline_m, 6), fmt::join(sources, ","), quoted(r.engine),
      r.device.empty() ? "null" : quoted(r.device), quoted(r.matcher), quoted(r.matcher_preset), quoted(r.tracker),
      r.focus ? R"("focus":true,)" : "", fmt::join(skeletons, ","), r.size.width, r.size.height, number(r.frame_s, 6));
}

std::string text_of(const Joint& joint) {
  const bool known = joint.state != JointState::kLost;
  const Vec3 p_m = joint.p_in_rig_m;
  const std::string p = known ? fmt::format("[{},{},{}]", number(p_m.x, 4), number(p_m.y, 4), number(p_m.z, 4)) : "null";
  const std::string uv = known ? fmt::format("[{},{}]", number(joint.u_px, 2), number(joint.v_px, 2)) : "null";
  return fmt::format(R"({{"p_in_rig_m":{},"uv_left_px":{},"state":"{}","confidence":{},"sigma_m":{}}})", p, uv,
                     state_text(joint.state), number(joint.confidence, 3), number(joint.sigma_m(), 4));
}

/// Of a person whose skeleton has fingers.
std::string pinch_text(const Person& person) {
  const auto text = [&](Side side) {
    const auto pinch = pinch_of(person, side);
    return pinch ? fmt::format(R"({{"distance_m":{},"sigma_m":{}}})", number(pinch->distance_m, 4), number(pinch->sigma_m, 4))
                 : "null";
  };
  return fmt::format(R"("pinch":{{"left":{},"right":{}}},)", text(Side::kLeft), text(Side::kRight));
}

std::string text_of(const Person& person) {
  std::vector<std::string> joints;
  for (std::size_t j = 0; j < person.count(); ++j)
    joints.push_back(fmt::format(R"("{}":{})", person.skeleton->joints[j].name, text_of(person.joints[j])));
  const bool has_fingers = person.skeleton->index_of(JointId::kLeftThumbTip).has_value();
  return fmt::format(R"({{"id":{},"skeleton":"{}",{}"joints":{{{}}}}})", person.id, person.skeleton->name,
                     has_fingers ? pinch_text(person) : "", fmt::join(joints, ","));
}

std::string frame_line(const TrackedFrame& frame, bool live) {
  std::vector<std::string> people;
  for (const Person& person : frame.people) people.push_back(text_of(person));
  std::string line = fmt::format(R"({{"type":"frame","frame":{},"t_s":{})", frame.number, number(frame.t_s, 6));
  if (live) line += fmt::format(R"(,"skew_ms":{})", number(static_cast<double>(frame.frame->skew_ns) * 1e-6, 3));
  line += fmt::format(R"(,"people":[{}])", fmt::join(people, ","));
  if (frame.times)
    line += fmt::format(R"(,"engine_ms":{},"tracker_ms":{})", number(frame.times->engine_ms, 3),
                        number(frame.times->tracker_ms, 3));
  if (frame.times && live) line += fmt::format(R"(,"latency_ms":{})", number(since_ms(frame.left->t_ns), 3));
  return line + "}\n";
}

class ToFile final : public Sink {
 public:
  ToFile(PartialFile file, bool live) : file_(std::move(file)), live_(live) {}
  Result<void> begin(const TrackHeader& header) { return file_.write(header_line(header)); }
  Result<void> write(const TrackedFrame& frame) override { return file_.write(frame_line(frame, live_)); }
  Result<void> finish() override { return file_.publish(); }

 private:
  PartialFile file_;
  bool live_;
};

class ToStdout final : public Sink {
 public:
  explicit ToStdout(bool live) : live_(live) {}
  Result<void> begin(const TrackHeader& header) { return print(header_line(header)); }
  Result<void> write(const TrackedFrame& frame) override { return print(frame_line(frame, live_)); }
  Result<void> finish() override { return {}; }

 private:
  /// Flushed line by line: who reads the pipe sees each frame when it is there.
  static Result<void> print(const std::string& line) {
    if (std::fwrite(line.data(), 1, line.size(), stdout) == line.size() && std::fflush(stdout) == 0) return {};
    return Error{ErrorCode::kWriteFailed, "cannot write to stdout; give a file with room instead"};
  }

  bool live_;
};

template <class T>
Result<std::unique_ptr<Sink>> begun(std::unique_ptr<T> sink, const TrackHeader& header) {
  DUO_TRY(sink->begin(header));
  return std::unique_ptr<Sink>(std::move(sink));
}

}  // namespace

Result<std::unique_ptr<Sink>> make_json_lines(const std::filesystem::path& path, const TrackHeader& header) {
  if (path.empty() || is_stdout(path)) return begun(std::make_unique<ToStdout>(header.live), header);
  DUO_TRY_ASSIGN(PartialFile file, PartialFile::open(path));
  return begun(std::make_unique<ToFile>(std::move(file), header.live), header);
}

}  // namespace duo
