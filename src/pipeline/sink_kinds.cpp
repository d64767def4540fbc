#include "duoptic/sink_kinds.h"

#include <algorithm>

#include "duoptic/stdout.h"

namespace duo {
namespace {

using Made = Result<std::unique_ptr<Sink>>;

template <auto kMake>
Made with_header(const std::string& target, const SinkTargets&, const TrackHeader& header, std::string&) {
  return kMake(target, header);
}

constexpr SinkKind kSinkKinds[] = {
    {"-o,--output", "FILE", "File for the JSON lines instead of stdout", "JSON lines", ".jsonl", true, SinkMaps::kNone,
     with_header<make_json_lines>},
    {"--video", "FILE", "MP4 with the four panels: joints, depth, body, hue", "Video", ".mp4", true, SinkMaps::kDrawn,
     [](const std::string& target, const SinkTargets&, const TrackHeader& header, std::string& note) -> Made {
       return make_panel_video(target, header, note);
     }},
    {"--csv", "FILE", "Table: a row per frame, person and joint", "CSV", ".csv", false, SinkMaps::kNone,
     [](const std::string& target, const SinkTargets& how, const TrackHeader&, std::string&) -> Made {
       return make_csv(target, how.axes);
     }},
    {"--bvh", "FILE", "Motion for Blender and other animation programs; metres, y up", "BVH", ".bvh", false, SinkMaps::kNone,
     with_header<make_bvh>},
    {"--gltf", "FILE", "Motion as a binary glTF 2.0, for Blender, game engines and browsers; metres, y up", "glTF", ".glb",
     false, SinkMaps::kNone, with_header<make_gltf>},
    {"--trc", "FILE", "Places of the joints as markers, for OpenSim; metres, y up", "TRC", ".trc", false, SinkMaps::kNone,
     with_header<make_trc>},
    {"--mcap", "FILE", "Depth, points and people as ROS 2 messages in an MCAP file, for ros2 bag and Foxglove", "MCAP", ".mcap",
     false, SinkMaps::kDepth, with_header<make_mcap>},
    {"--osc", "HOST:PORT", "Send OSC messages by UDP; nothing is received", "OSC", "127.0.0.1:9000", false, SinkMaps::kNone,
     [](const std::string& target, const SinkTargets& how, const TrackHeader&, std::string&) -> Made {
       return make_osc(target, how.axes);
     }},
    {"--vmc", "HOST:PORT", "Send avatar bones (Virtual Motion Capture protocol) by UDP; nothing is received", "VMC",
     "127.0.0.1:39539", false, SinkMaps::kNone,
     [](const std::string& target, const SinkTargets& how, const TrackHeader&, std::string&) -> Made {
       return make_vmc(target, how.vmc_bones);
     }},
};

/// Whether there is an output whose kind needs that.
bool needs(const SinkTargets& how, SinkMaps maps) {
  for (std::size_t i = 0; i < how.targets.size(); ++i)
    if (kSinkKinds[i].maps == maps && !how.targets[i].empty()) return true;
  return false;
}

}  // namespace

std::span<const SinkKind> sink_kinds() { return kSinkKinds; }

bool SinkTargets::wants_maps() const { return needs(*this, SinkMaps::kDrawn) || writes_depth(); }
bool SinkTargets::writes_depth() const { return needs(*this, SinkMaps::kDepth); }

std::ptrdiff_t SinkTargets::sent_to_stdout() const {
  std::ptrdiff_t count = 0;
  for (const auto& paths : targets) count += std::count_if(paths.begin(), paths.end(), is_stdout);
  return count;
}

Result<std::string> SinkTargets::add_to(Pipeline& pipeline, const SinkKind& kind, const std::string& target) const {
  std::string note;
  DUO_TRY_ASSIGN(auto sink, kind.make(target, *this, pipeline.header(), note));
  DUO_TRY(pipeline.add_sink(target.empty() ? "stdout" : target, std::move(sink)));
  return note;
}

Result<std::vector<std::string>> SinkTargets::add_all_to(Pipeline& pipeline) const {
  std::vector<std::string> notes;
  for (std::size_t i = 1; i <= targets.size(); ++i) {
    const std::size_t kind = i % targets.size();
    for (const std::string& target : targets[kind]) {
      DUO_TRY_ASSIGN(std::string note, add_to(pipeline, kSinkKinds[kind], target));
      if (!note.empty()) notes.push_back(std::move(note));
    }
  }
  return notes;
}

}  // namespace duo
