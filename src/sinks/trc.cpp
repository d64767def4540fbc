// Track row column, the table of marker places that Motion Analysis's programs write and OpenSim reads.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/file.h"
#include "duoptic/sink.h"
#include "sinks/motion_tracks.h"
#include "sinks/text_values.h"

namespace duo {
namespace {

class Trc final : public Sink {
 public:
  Trc(PartialFile file, std::string name, const TrackHeader& header)
      : file_(std::move(file)), name_(std::move(name)), slots_(header.frame_s) {
    for (const Skeleton* skeleton : header.skeletons) first_.push_back({0, skeleton, {}});
  }

  Result<void> write(const TrackedFrame& frame) override {
    const std::size_t slot = slots_.slot_at(frame.t_s);
    for (const Person& person : frame.people)
      if (person.skeleton != nullptr) add(slot, person);
    return {};
  }

  Result<void> finish() override {
    // A table needs columns, also where nobody came.
    const std::vector<Track> tracks = !tracks_.empty() || first_.empty() ? tracks_ : std::vector<Track>{first_[0]};
    std::size_t markers = 0;
    std::string names = "Frame#\tTime", axes = "\t";
    for (const Track& track : tracks)
      for (const JointDef& joint : track.skeleton->joints) {
        ++markers;
        names += fmt::format("\t{}{}\t\t", joint.name, name_end(tracks, track));
        axes += fmt::format("\tX{0}\tY{0}\tZ{0}", markers);
      }
    const std::string rate = number(1 / slots_.frame_s(), 4);
    std::string text = fmt::format(
        "PathFileType\t4\t(X/Y/Z)\t{0}\n"
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n"
        "{1}\t{1}\t{2}\t{3}\tm\t{1}\t1\t{2}\n{4}\n{5}\n\n",
        name_, rate, slots_.count(), markers, names, axes);
    for (std::size_t i = 0; i < slots_.count(); ++i) {
      text += fmt::format("{}\t{}", i + 1, number(static_cast<double>(i) * slots_.frame_s(), 6));
      for (const Track& track : tracks) append_row(track, i, text);
      text += '\n';
    }
    DUO_TRY(file_.write(text));
    return file_.publish();
  }

 private:
  struct Track {
    std::uint32_t id;
    const Skeleton* skeleton;
    std::vector<std::vector<std::optional<Vec3>>> frames;  // y up; none where lost
  };

  void add(std::size_t slot, const Person& person) {
    auto found = std::find_if(tracks_.begin(), tracks_.end(),
                              [&](const Track& track) { return track.id == person.id && track.skeleton == person.skeleton; });
    if (found == tracks_.end()) found = tracks_.insert(tracks_.end(), {person.id, person.skeleton, {}});
    found->frames.resize(std::max(found->frames.size(), slot + 1));
    auto& places = found->frames[slot];
    places.clear();
    for (std::size_t j = 0; j < person.count(); ++j) {
      const Joint& joint = person.joints[j];
      places.push_back(joint.state == JointState::kLost ? std::nullopt
                                                        : std::optional(axes_from_rig(Axes::kOpengl) * joint.p_in_rig_m));
    }
  }

  /// A second person with the same joints has names of its own.
  static std::string name_end(const std::vector<Track>& tracks, const Track& track) {
    const bool first = std::find_if(tracks.begin(), tracks.end(), [&](const Track& other) {
                         return other.skeleton == track.skeleton;
                       })->id == track.id;
    return first ? "" : fmt::format("_{}", track.id);
  }

  static void append_row(const Track& track, std::size_t slot, std::string& text) {
    const bool there = slot < track.frames.size() && !track.frames[slot].empty();
    for (std::size_t j = 0; j < track.skeleton->joints.size(); ++j) {
      const std::optional<Vec3> p_m = there ? track.frames[slot][j] : std::nullopt;
      text += p_m ? fmt::format("\t{}\t{}\t{}", number(p_m->x, 5), number(p_m->y, 5), number(p_m->z, 5)) : "\t\t\t";
    }
  }

  PartialFile file_;
  std::string name_;
  FrameSlots slots_;
  std::vector<Track> first_, tracks_;
};

}  // namespace

Result<std::unique_ptr<Sink>> make_trc(const std::filesystem::path& path, const TrackHeader& header) {
  DUO_TRY_ASSIGN(PartialFile file, PartialFile::open(path));
  return std::unique_ptr<Sink>(std::make_unique<Trc>(std::move(file), path.filename().string(), header));
}

}  // namespace duo
