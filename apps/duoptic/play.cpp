// duoptic play: what is in a recording, and its parts as files of their own.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "command.h"
#include "duoptic/output_set.h"
#include "duoptic/recording.h"
#include "duoptic/rig.h"
#include "rig_report.h"

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

double rate(const RecordingReport& r) { return r.length_s > 0 ? static_cast<double>(r.pairs - 1) / r.length_s : 0; }

nlohmann::json to_json(const RecordedView& view) {
  return {{"codec", view.codec}, {"pictures", view.pictures}, {"missing", view.missing}};
}

void print(const RecordingReport& r, const Options& options, const std::vector<std::string>& files) {
  if (options.json) {
    const nlohmann::json out = {{"file", options.recording},
                                {"left", to_json(r.left)},
                                {"right", to_json(r.right)},
                                {"width", r.size.width},
                                {"height", r.size.height},
                                {"pairs", r.pairs},
                                {"length_s", r.length_s},
                                {"rate_hz", rate(r)},
                                {"longest_gap_s", r.longest_gap_s},
                                {"skew_s", r.skew_s},
                                {"bytes", r.bytes},
                                {"rig", r.rig ? app::to_json(*r.rig) : nlohmann::json()},
                                {"date", r.date},
                                {"cut", r.cut},
                                {"files", files}};
    fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return;
  }
  fmt::print("tracks   left {}, right {}, {}x{}\n", r.left.codec, r.right.codec, r.size.width, r.size.height);
  fmt::print("length   {} pairs in {:.2f} s, {:.2f} a second, longest gap {:.0f} ms, {:.1f} MB{}\n", r.pairs, r.length_s,
             rate(r), 1e3 * r.longest_gap_s, static_cast<double>(r.bytes) * 1e-6, r.date.empty() ? "" : ", taken " + r.date);
  fmt::print("drops    {} left and {} right pictures were taken and are not in it\n", r.left.missing, r.right.missing);
  fmt::print("skew     {:.1f} ms at most between the pictures of a pair\n", 1e3 * r.skew_s);
  fmt::print("rig      {}\n", r.rig ? describe(*r.rig) : "none; give --rig to the commands that need one");
  if (!files.empty()) fmt::print("written  {}\n", fmt::join(files, ", "));
}

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
  print(report, options, files);
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
