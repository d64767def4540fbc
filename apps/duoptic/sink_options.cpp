#include "sink_options.h"

#include <fmt/format.h>

#include <algorithm>

namespace duo::app {
namespace {

using Made = Result<std::unique_ptr<Sink>>;

constexpr SinkKind kSinkKinds[] = {
    {"-o,--output", "FILE", "File for the JSON lines instead of stdout", "JSON lines", ".jsonl",
     [](const std::string& target, const SinkOptions&, const TrackHeader& header, std::string&) -> Made {
       return make_json_lines(target, header);
     }},
    {"--video", "FILE", "MP4 with the four panels: joints, depth, body, hue", "Video", ".mp4",
     [](const std::string& target, const SinkOptions&, const TrackHeader& header, std::string& note) -> Made {
       return make_panel_video(target, header, note);
     }},
    {"--csv", "FILE", "Table: a row per frame, person and joint", "CSV", ".csv",
     [](const std::string& target, const SinkOptions& options, const TrackHeader&, std::string&) -> Made {
       DUO_TRY_ASSIGN(const Axes axes, axes_of(options.axes));
       return make_csv(target, axes);
     }},
    {"--bvh", "FILE", "Motion for Blender and other animation programs; metres, y up", "BVH", ".bvh",
     [](const std::string& target, const SinkOptions&, const TrackHeader& header, std::string&) -> Made {
       return make_bvh(target, header);
     }},
    {"--gltf", "FILE", "Motion as a binary glTF 2.0, for Blender, game engines and browsers; metres, y up", "glTF", ".glb",
     [](const std::string& target, const SinkOptions&, const TrackHeader& header, std::string&) -> Made {
       return make_gltf(target, header);
     }},
    {"--trc", "FILE", "Places of the joints as markers, for OpenSim; metres, y up", "TRC", ".trc",
     [](const std::string& target, const SinkOptions&, const TrackHeader& header, std::string&) -> Made {
       return make_trc(target, header);
     }},
    {"--mcap", "FILE", "Depth, points and people as ROS 2 messages in an MCAP file, for ros2 bag and Foxglove", "MCAP", ".mcap",
     [](const std::string& target, const SinkOptions&, const TrackHeader& header, std::string&) -> Made {
       return make_mcap(target, header);
     }},
    {"--osc", "HOST:PORT", "Send OSC messages by UDP; nothing is received", "OSC", "127.0.0.1:9000",
     [](const std::string& target, const SinkOptions& options, const TrackHeader&, std::string&) -> Made {
       DUO_TRY_ASSIGN(const Axes axes, axes_of(options.axes));
       return make_osc(target, axes);
     }},
    {"--vmc", "HOST:PORT", "Send avatar bones (Virtual Motion Capture protocol) by UDP; nothing is received", "VMC",
     "127.0.0.1:39539",
     [](const std::string& target, const SinkOptions& options, const TrackHeader&, std::string&) -> Made {
       return make_vmc(target, options.vmc_bones);
     }},
};
constexpr std::size_t kLines = 0, kVideo = 1, kMcap = 6;

std::vector<std::string> axes_names() { return {kAxesNames.begin(), kAxesNames.end()}; }

}  // namespace

std::span<const SinkKind> sink_kinds() { return kSinkKinds; }

void SinkOptions::add_to(CLI::App& app) {
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const SinkKind& kind = kSinkKinds[i];
    CLI::Option* option = app.add_option(kind.option, targets[i], kind.help)->type_name(kind.type)->allow_extra_args(false);
    if (i == kLines || i == kVideo) option->expected(1);
  }
  app.add_flag_callback(
      "--vmc-rotations", [this] { vmc_bones = VmcBones::kRotations; },
      "Of bones send rotations alone, positions 0: for receivers that would stretch the avatar, see docs/formats.md");
  app.add_option("--axes", axes, "Coordinate system of --csv and --osc, see docs/formats.md")
      ->check(CLI::IsMember(axes_names()))
      ->capture_default_str();
}

bool SinkOptions::wants_maps() const { return !targets[kVideo].empty() || writes_depth(); }
bool SinkOptions::writes_depth() const { return !targets[kMcap].empty(); }

/// How many outputs were sent to stdout.
std::ptrdiff_t SinkOptions::sent_to_stdout() const {
  std::ptrdiff_t count = 0;
  for (const auto& paths : targets) count += std::count_if(paths.begin(), paths.end(), is_stdout);
  if (count > 1) throw CLI::ValidationError("stdout", "takes one output; give a file to each of the others");
  return count;
}

bool SinkOptions::on_stdout() const { return lines_on_stdout() || sent_to_stdout() > 0; }
bool SinkOptions::lines_on_stdout() const { return targets[kLines].empty() && sent_to_stdout() == 0; }

Result<std::string> SinkOptions::add_sink(Pipeline& pipeline, const SinkKind& kind, const std::string& target) const {
  std::string note;
  DUO_TRY_ASSIGN(auto sink, kind.make(target, *this, pipeline.header(), note));
  DUO_TRY(pipeline.add_sink(target.empty() ? "stdout" : target, std::move(sink)));
  return note;
}

/// JSON lines last: they may go to stdout, where they must not begin before all else could be opened.
Result<void> SinkOptions::add_sinks(Pipeline& pipeline, const CLI::App& app) const {
  static_cast<void>(sent_to_stdout());
  for (std::size_t i = 1; i <= targets.size(); ++i) {
    const std::size_t kind = i % targets.size();
    for (const std::string& target : targets[kind]) {
      DUO_TRY_ASSIGN(const std::string note, add_sink(pipeline, kSinkKinds[kind], target));
      if (!note.empty()) say(app, "warning: " + note);
    }
  }
  return {};
}

std::string dropped_text(const Pipeline& pipeline) {
  std::string text;
  for (const auto& [name, count] : pipeline.dropped_by_sinks()) text += fmt::format(", {} dropped by {}", count, name);
  return text;
}

}  // namespace duo::app
