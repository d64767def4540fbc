// duoptic play: what is in a recording, and its parts as files of their own.
#include <fmt/format.h>

#include <memory>

#include "command.h"
#include "duoptic/output_set.h"
#include "duoptic/reports.h"

namespace duo::app::play {
namespace {

constexpr char kFooter[] =
    "Prints what a recording holds: codecs, pairs, length, rate, gaps, pictures that the cameras took and the file lacks, "
    "rig.\n"
    "--export writes left.avi and right.avi (the same packets), times.csv (capture times) and rig.json into a folder.\n"
    "Every command that takes LEFT takes a recording alone; its rig is used where --rig is left out.\n\n"
    "Examples:\n"
    "  duoptic play clip.mkv\n"
    "  duoptic play clip.mkv --export clip\n"
    "  duoptic depth clip.mkv -o out";

struct Options {
  std::string recording, folder;
  bool json = false;
};

Result<Exit> run(const Options& options, const CLI::App& app) {
  DUO_TRY_ASSIGN(const RecordingReport report, inspect_recording(options.recording));
  std::vector<std::string> files;
  if (!options.folder.empty()) {
    DUO_TRY_ASSIGN(OutputSet out, OutputSet::open(options.folder));
    DUO_TRY(export_recording(options.recording, {out / "left.avi", out / "right.avi", out / "times.csv"}));
    if (report.rig) DUO_TRY(save_rig(*report.rig, out / "rig.json"));
    DUO_TRY(out.publish());
    files = out.paths();
  }
  fmt::print("{}", options.json ? json_of(report, options.recording, files) + "\n" : text_of(report));
  if (!options.json && !files.empty()) fmt::print("written  {}\n", fmt::join(files, ", "));
  if (report.cut)
    say(app, fmt::format("warning: {} was killed or cut; its {} whole pairs are good", options.recording, report.pairs));
  return report.cut ? Exit::kCut : Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("play", "What a recording holds, and its parts as files");
  const auto options = std::make_shared<Options>();
  sub->add_option("RECORDING", options->recording, "What duoptic record wrote")->required();
  sub->add_option("--export", options->folder, "Write its videos, capture times and rig into a folder")->type_name("DIR");
  sub->add_flag("--json", options->json, "Print it as JSON");
  sub->footer(kFooter);
  return {sub, [options, sub] { return run(*options, *sub); }};
}

}  // namespace duo::app::play
