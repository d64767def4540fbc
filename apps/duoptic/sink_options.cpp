#include "sink_options.h"

#include <fmt/format.h>

namespace duo::app {

void SinkOptions::add_to(CLI::App& app) {
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const SinkKind& kind = sink_kinds()[i];
    CLI::Option* option = app.add_option(kind.option, targets[i], kind.help)->type_name(kind.type)->allow_extra_args(false);
    if (kind.once) option->expected(1);
  }
  app.add_flag_callback(
      "--vmc-rotations", [this] { vmc_bones = VmcBones::kRotations; },
      "Of bones send rotations alone, positions 0: for receivers that would stretch the avatar, see docs/formats.md");
  add_choice_option(app, "--axes", axes, kAxesNames, "Coordinate system of --csv and --osc, see docs/formats.md");
}

bool SinkOptions::lines_on_stdout() const {
  const std::ptrdiff_t count = sent_to_stdout();
  if (count > 1) throw CLI::ValidationError("stdout", "takes one output; give a file to each of the others");
  return targets.front().empty() && count == 0;
}

std::string dropped_text(const Pipeline& pipeline) {
  std::string text;
  for (const auto& [name, count] : pipeline.dropped_by_sinks()) text += fmt::format(", {} dropped by {}", count, name);
  return text;
}

}  // namespace duo::app
