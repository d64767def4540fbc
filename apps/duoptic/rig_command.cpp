// duoptic rig: how good a rig is, putting one right, and other programs' rig files.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <thread>

#include "command.h"
#include "duoptic/interrupt.h"
#include "duoptic/reports.h"
#include "duoptic/rig_files.h"
#include "input.h"

namespace duo::app::rig {
namespace {

constexpr char kCheckFooter[] =
    "Without pictures the rig's numbers are checked; with LEFT RIGHT (raw pictures or videos of any scene with texture) the\n"
    "scene's points too: how far they are from lying on one row, and how the cameras have turned since.\n"
    "Verdicts: good; can be improved (duoptic rig refine); recalibrate. Exit 0, or 4 for recalibrate.\n\n"
    "Examples:\n"
    "  duoptic rig check rig.json\n"
    "  duoptic rig check rig.json left.avi right.avi --json";
constexpr char kRefineFooter[] =
    "The lenses and the length of the baseline stay; tilt and roll are found in the scene, pan only where the scene is sure "
    "of\n"
    "it. A good rig is left as it is. Nothing is written when the result would still be useless (exit 4).\n\n"
    "Example:\n"
    "  duoptic rig refine rig.json left.avi right.avi -o refined.json";
constexpr char kImportFooter[] =
    "Reads our JSON; OpenCV's YAML, JSON and XML, in one file or as intrinsics and extrinsics; Kalibr's camchain\n"
    "(pinhole-radtan); ROS camera_info as one YAML with both cameras, a folder with left.yaml and right.yaml, or two files;\n"
    "Middlebury's calib.txt; KITTI's calib_cam_to_cam.txt and calib.txt (the rectified pair, in colour where it is there); "
    "ZED's SN*.conf.\n\n"
    "Examples:\n"
    "  duoptic rig import camchain.yaml -o rig.json\n"
    "  duoptic rig import left.yaml right.yaml -o rig.json\n"
    "  duoptic rig import intrinsics.yml extrinsics.yml --size 640x480 -o rig.json\n"
    "  duoptic rig import SN1234.conf --size 1280x720 -o rig.json";
constexpr char kExportFooter[] =
    "opencv: FILE.yml, .yaml or .json with M1 D1 M2 D2 R T R1 R2 P1 P2 Q. ros: FILE.yaml holds both cameras' camera_info, any\n"
    "other name is a folder for left.yaml and right.yaml. ros-rectified: the same of the rectified pictures, which are what\n"
    "left_rectified.png and depth.png of duoptic depth are. kalibr: FILE.yaml, a camchain.\n\n"
    "Examples:\n"
    "  duoptic rig export rig.json --to opencv -o stereo.yml\n"
    "  duoptic rig export rig.json --to ros -o camera_info";

const std::map<std::string, RigFormat> kFormats = {{"opencv", RigFormat::kOpencv},
                                                   {"ros", RigFormat::kRos},
                                                   {"kalibr", RigFormat::kKalibr},
                                                   {"ros-rectified", RigFormat::kRosRectified}};

struct Options {
  std::string rig, left, right, output, format = "opencv";
  InputOptions input;
  Size size;
  int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  bool json = false;
};

nlohmann::json parsed(const std::string& report) { return nlohmann::json::parse(report); }

Result<Exit> check(const Options& options, const CLI::App& app) {
  Interrupt::end_at_once();
  DUO_TRY_ASSIGN(const Rig rig, load_rig(options.rig));
  const std::vector<RigDoubt> doubts = rig_doubts(rig);
  std::optional<SceneHealth> scene;
  if (!options.left.empty()) {
    DUO_TRY_ASSIGN(const auto pairs, open_pairs(options.left, options.right, options.input.wish(rig)));
    DUO_TRY_ASSIGN(scene, scene_health(rig, *pairs, options.threads));
    if (!pairs->warning().empty()) say(app, "warning: " + pairs->warning());
  }
  const RigVerdict verdict = overall(doubts, scene ? &*scene : nullptr);
  if (options.json) {
    nlohmann::json out = {{"verdict", name_of(verdict)}, {"rig", parsed(json_of(rig))}, {"doubts", nlohmann::json::array()}};
    for (const RigDoubt& doubt : doubts) out["doubts"].push_back({{"verdict", name_of(doubt.verdict)}, {"what", doubt.what}});
    out["scene"] = scene ? parsed(json_of(*scene)) : nlohmann::json();
    print_json(out);
  } else {
    fmt::print("rig      {}\n", text_of(rig));
    for (const RigDoubt& doubt : doubts) fmt::print("doubt    {}\n", doubt.what);
    fmt::print("{}verdict  {}{}\n", scene ? text_of(*scene) : "", name_of(verdict),
               scene ? "" : " as far as its numbers tell; give pictures to see whether it still fits the cameras");
  }
  if (verdict == RigVerdict::kRecalibrate) return Exit::kInput;
  return scene && scene->cut ? Exit::kCut : Exit::kOk;
}

Result<Exit> refine(const Options& options, const CLI::App& app) {
  const bool prints = may_print(options.output, options.json);
  DUO_TRY_ASSIGN(const Rig rig, load_rig(options.rig));
  DUO_TRY_ASSIGN(const auto pairs, open_pairs(options.left, options.right, options.input.wish(rig)));
  DUO_TRY_ASSIGN(SceneRig found, refine_rig(rig, *pairs, options.threads));
  if (!(found.rig.right_from_left == rig.right_from_left)) found.rig.date = date_now();
  const bool useful = found.after.verdict != RigVerdict::kRecalibrate;
  if (Interrupt::asked()) return stopped("the rig was written");
  if (useful && !options.output.empty()) DUO_TRY(save_rig(found.rig, options.output));
  if (options.json) {
    print_json({{"verdict", name_of(found.after.verdict)},
                {"before", parsed(json_of(found.before))},
                {"after", parsed(json_of(found.after))},
                {"rig", parsed(json_of(found.rig))},
                {"file", useful ? nlohmann::json(options.output) : nlohmann::json()}});
  } else if (prints) {
    fmt::print("before   {}\n{}after    {}\n{}", name_of(found.before.verdict), text_of(found.before),
               name_of(found.after.verdict), text_of(found.after));
    if (useful) fmt::print("{}\n", options.output.empty() ? "nothing written (no -o)" : "written to " + options.output);
  }
  if (!pairs->warning().empty()) say(app, "warning: " + pairs->warning());
  if (!found.after.missing.empty()) say(app, "warning: no points in " + found.after.missing + "; move the rig and try again");
  if (found.after.verdict == RigVerdict::kCanBeImproved && found.after.pan_px > 2 * found.after.pan_sigma_px)
    say(app,
        fmt::format(
            "warning: this scene cannot tell the pan well, and the rig's may be wrong by {:.1f} +- {:.1f} px of disparity; "
            "show one with points near and far all over the picture, or calibrate with a board",
            found.after.pan_px, found.after.pan_sigma_px));
  if (!useful)
    say(app, fmt::format("the rig cannot be put right by this scene (rows {:.2f} px off); calibrate with a board",
                         found.after.row_px));
  if (!useful) return Exit::kInput;
  return found.after.cut ? Exit::kCut : Exit::kOk;
}

Result<Exit> import_file(const Options& options, const CLI::App& app) {
  const bool prints = may_print(options.output, options.json);
  DUO_TRY_ASSIGN(const RigImport read, import_rig(options.left, options.right, options.size));
  DUO_TRY(save_rig(read.rig, options.output));
  if (options.json)
    print_json({{"rig", parsed(json_of(read.rig))}, {"file", options.output}, {"note", read.note}});
  else if (prints)
    fmt::print("{}: {}\n", options.output, text_of(read.rig));
  if (!read.note.empty()) say(app, "note: " + read.note);
  for (const RigDoubt& doubt : rig_doubts(read.rig)) say(app, "warning: " + doubt.what);
  return Exit::kOk;
}

Result<Exit> export_file(const Options& options, const CLI::App& app) {
  DUO_TRY_ASSIGN(const Rig rig, load_rig(options.rig));
  DUO_TRY_ASSIGN(const RigExport written, export_rig(rig, kFormats.at(options.format), options.output));
  if (options.json) {
    nlohmann::json out = {{"files", nlohmann::json::array()}, {"lens_error_px", written.lens_error_px}};
    for (const auto& file : written.files) out["files"].push_back(file.string());
    print_json(out);
  } else {
    for (const auto& file : written.files) fmt::print("{}\n", file.string());
  }
  if (written.lens_error_px > 0.01)
    say(app, fmt::format("warning: this format's lens has fewer coefficients and lies up to {:.2f} px beside the rig's",
                         written.lens_error_px));
  return Exit::kOk;
}

struct Subcommands {
  CLI::App *check, *refine, *import, *export_to;
};

Subcommands add_subcommands(CLI::App& rig, Options& options) {
  const auto add_pictures = [&](CLI::App& sub, bool required) {
    sub.add_option("LEFT", options.left, "Raw pictures or video of the left camera, or of both")->required(required);
    sub.add_option("RIGHT", options.right, "Of the right camera");
    options.input.add_to(sub);
    sub.add_option("--threads", options.threads, "Threads; the result does not depend on them")
        ->check(within(1, 256))
        ->capture_default_str();
  };
  const auto add_output = [&](CLI::App& sub, const char* what, bool required) {
    sub.add_option("-o,--output", options.output, what)->type_name("FILE")->required(required);
  };
  const auto add_json = [&](CLI::App& sub) { sub.add_flag("--json", options.json, "Print it as JSON"); };

  CLI::App* check = rig.add_subcommand("check", "Whether a rig can be trusted");
  check->add_option("RIG", options.rig, "Rig file")->required();
  add_pictures(*check, false);
  add_json(*check);
  check->footer(kCheckFooter);

  CLI::App* refine = rig.add_subcommand("refine", "Put a nudged rig right, from any scene");
  refine->add_option("RIG", options.rig, "Rig file")->required();
  add_pictures(*refine, true);
  add_output(*refine, "File for the corrected rig; without it the change is only printed", false);
  add_json(*refine);
  refine->footer(kRefineFooter);

  CLI::App* import = rig.add_subcommand("import", "Read another program's rig");
  import->add_option("FILE", options.left, "Calibration of both cameras, or of the left one (ROS)")->required();
  import->add_option("RIGHT", options.right, "Calibration of the right camera (ROS), or the pose (OpenCV's extrinsics)");
  add_size_option(*import, options.size, "Of the pictures, for files that do not say it or hold several");
  add_output(*import, "Rig file", true);
  add_json(*import);
  import->footer(kImportFooter);

  CLI::App* export_to = rig.add_subcommand("export", "Write a rig for another program");
  export_to->add_option("RIG", options.rig, "Rig file")->required();
  export_to->add_option("--to", options.format, "Whose format")->check(CLI::IsMember(kFormats))->required();
  add_output(*export_to, "File, or folder for ros and ros-rectified", true);
  add_json(*export_to);
  export_to->footer(kExportFooter);
  return {check, refine, import, export_to};
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("rig", "Check, refine, import or export a rig file");
  sub->require_subcommand(1);
  const auto options = std::make_shared<Options>();
  const Subcommands subs = add_subcommands(*sub, *options);
  return {sub, [options, sub, subs]() -> Result<Exit> {
            if (subs.check->parsed()) return check(*options, *sub);
            if (subs.refine->parsed()) return refine(*options, *sub);
            if (subs.import->parsed()) return import_file(*options, *sub);
            return export_file(*options, *sub);
          }};
}

}  // namespace duo::app::rig
