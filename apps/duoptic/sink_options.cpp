#include "sink_options.h"

#include <fmt/format.h>

namespace duo::app {
namespace {

std::vector<std::string> axes_names() { return {kAxesNames.begin(), kAxesNames.end()}; }

}  // namespace

void SinkOptions::add_to(CLI::App& app) {
  app.add_option("-o,--output", lines, "File for the JSON lines instead of stdout")->type_name("FILE");
  app.add_option("--video", video, "MP4 with the four panels: joints, depth, body, hue")->type_name("FILE");
  const auto add_many = [&](const char* name, std::vector<std::string>& to, const char* type, const char* what) {
    app.add_option(name, to, what)->type_name(type)->allow_extra_args(false);
  };
  add_many("--csv", csv, "FILE", "Table: a row per frame, person and joint");
  add_many("--bvh", bvh, "FILE", "Motion for Blender and other animation programs, metres, y up");
  add_many("--osc", osc, "HOST:PORT", "Send OSC messages a frame by UDP, send-only");
  add_many("--vmc", vmc, "HOST:PORT", "Send avatar bones (Virtual Motion Capture protocol) by UDP, send-only");
  app.add_option("--axes", axes, "Coordinate system of --csv and --osc, see docs/formats.md")
      ->check(CLI::IsMember(axes_names()))
      ->capture_default_str();
}

Result<std::vector<NamedSink>> SinkOptions::make(const TrackHeader& header, bool live, const CLI::App& app) const {
  DUO_TRY_ASSIGN(const Axes known_axes, axes_of(axes));
  std::vector<NamedSink> sinks;
  const auto add = [&](const std::string& name, Result<std::unique_ptr<Sink>> made) -> Result<void> {
    if (!made) return made.error();
    const bool waits = live && !(*made)->instant();
    sinks.push_back({name, waits ? in_background(std::move(*made)) : std::move(*made)});
    return {};
  };
  if (!video.empty()) {
    std::string note;
    DUO_TRY(add(video, make_panel_video(video, header, note)));
    if (!note.empty()) say(app, "warning: " + note);
  }
  for (const std::string& file : csv) DUO_TRY(add(file, make_csv(file, known_axes)));
  for (const std::string& file : bvh) DUO_TRY(add(file, make_bvh(file, header)));
  for (const std::string& target : osc) DUO_TRY(add(target, make_osc(target, known_axes)));
  for (const std::string& target : vmc) DUO_TRY(add(target, make_vmc(target)));
  DUO_TRY(add(lines.empty() ? "stdout" : lines, make_json_lines(lines, header)));
  return sinks;
}

std::string dropped_text(const std::vector<NamedSink>& sinks) {
  std::string text;
  for (const auto& [name, sink] : sinks)
    if (sink->dropped() > 0) text += fmt::format(", {} dropped by {}", sink->dropped(), name);
  return text;
}

}  // namespace duo::app
