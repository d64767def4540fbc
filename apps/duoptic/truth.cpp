// duoptic truth: the true disparity of one's own desk, by structured light.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <thread>

#include "duoptic/interrupt.h"
#include "duoptic/reports.h"
#include "input.h"
#include "progress.h"
#ifdef DUO_VIEWER
#include "../viewer/pattern_screen.h"
#endif

namespace duo::app::truth {
namespace {

namespace fs = std::filesystem;

constexpr char kFooter[] =
    "A projector lights the scene with stripes and sines that number its pixels; where both cameras see the same number they\n"
    "see the same point. What comes out is a scene for duoptic eval middlebury. docs/truth.md shows how to set it up.\n\n"
    "Examples:\n"
    "  duoptic truth record camera:0 camera:2 --rig rig.json --display 1 -o recorded   shows and records all patterns\n"
    "  duoptic truth decode recorded --rig rig.json -o desk                            makes the scene\n"
    "  duoptic eval middlebury desk                                                    scores matchers on it";
constexpr char kPatternsFooter[] =
    "Writes pattern_000.png on and patterns.json. Show them by any means, in their order and pixel for pixel, take a picture "
    "of\n"
    "each with both cameras, and name these left_000.png and right_000.png on; copy patterns.json beside them.\n\n"
    "Example:\n"
    "  duoptic truth patterns --size 1280x720 -o patterns";
constexpr char kRecordFooter[] =
    "Covers a display (a projector is one) with gray for some seconds, in which the cameras lock their exposure, then with "
    "each\n"
    "pattern until both cameras see it at rest. Escape or Q ends it. Writes left_000.png, right_000.png on and patterns.json;\n"
    "DIR appears when all is done. Where parts are too bright or too dark, record again with another --brightness and decode\n"
    "both folders together.\n\n"
    "Examples:\n"
    "  duoptic truth record camera:0 camera:2 --rig rig.json --display 1 -o recorded\n"
    "  duoptic truth record camera:0 camera:2 --rig rig.json --display 1 --brightness 25 -o dim";
constexpr char kDecodeFooter[] =
    "Each DIR has the pictures of all patterns, recorded with another exposure or brightness of the same, still scene; each "
    "pixel\n"
    "takes the one in which it sees the patterns best. Writes into the scene's folder: left.png and right.png (rectified, in\n"
    "ordinary light), disp_left.png (16 bits), meta.json, and disparity.png to look at. Pixels in shadow, too bright or in "
    "doubt\n"
    "stay unknown.\n\n"
    "Examples:\n"
    "  duoptic truth decode recorded --rig rig.json -o desk\n"
    "  duoptic truth decode recorded dim --rig rig.json --light left.png --light right.png -o desk --json";

/// Up to a signal.
LightProgress counted(Progress& progress) {
  return [&progress](std::size_t done) {
    progress.frame(static_cast<std::int64_t>(done));
    return !Interrupt::asked();
  };
}

struct ShownOptions {
  LightCode code;
  int brightness_percent = 100;
  std::string folder;
  bool quiet = false, json = false;

  int white() const { return (255 * brightness_percent + 50) / 100; }
  void add_to(CLI::App& app) {
    app.add_option("--period", code.period_px,
                   "Of the sine in px of the projector, even; wider where the cameras see its pixels small or blurred")
        ->type_name("PX")
        ->check(within(8, 256))
        ->capture_default_str();
    app.add_option("--brightness", brightness_percent, "Of white, in %; less for scenes that are too bright")
        ->type_name("PERCENT")
        ->check(within(1, 100))
        ->capture_default_str();
    app.add_flag("--json", json, "Print the summary as JSON");
    app.add_flag("--quiet", quiet, "No progress and no summary");
  }
};

Result<Exit> write_patterns(const ShownOptions& options, const CLI::App& app) {
  DUO_TRY(check_light_code(options.code));
  const auto count = light_patterns(options.code).size();
  {
    Progress progress(app, static_cast<std::int64_t>(count), options.quiet);
    DUO_TRY(write_light_patterns(options.code, options.white(), options.folder, counted(progress)));
  }
  if (options.json)
    fmt::print("{}\n", json_of(options.code, options.folder));
  else if (!options.quiet)
    fmt::print("{}: {} patterns of {}x{}\n", options.folder, count, options.code.screen.width, options.code.screen.height);
  return Exit::kOk;
}

struct RecordOptions : ShownOptions {
  InputOptions input;
  LightRecording how;
  int display = 0;
};

#ifdef DUO_VIEWER
Result<Exit> record(RecordOptions options, const CLI::App& app) {
  DUO_TRY_ASSIGN(Input input, options.input.open());
  if (!input.pairs->live())
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot record patterns from {}: files do not see the screen; give two cameras, "
                             "or decode pictures that were taken of the patterns",
                             options.input.left)};
  DUO_TRY_ASSIGN(view::PatternScreen shown, view::open_pattern_screen(options.display));
  options.code.screen = shown.size;
  options.how.white = options.white();
  const auto count = static_cast<std::int64_t>(light_patterns(options.code).size());
  Progress progress(app, count, options.quiet);
  DUO_TRY(record_light_folder(*input.pairs, options.code, options.how, *shown.screen, options.folder, counted(progress)));
  if (options.json)
    fmt::print("{}\n", json_of(options.code, options.folder));
  else if (!options.quiet)
    fmt::print("{}: {} patterns of {}x{}, recorded by both cameras; duoptic truth decode {} makes the scene\n", options.folder,
               count, options.code.screen.width, options.code.screen.height, options.folder);
  if (const std::string warning = input.pairs->warning(); !warning.empty()) say(app, "warning: " + warning);
  return Exit::kOk;
}
#else
Result<Exit> record(const RecordOptions&, const CLI::App&) {
  return Error{
      ErrorCode::kUnsupported,
      "cannot show patterns: this build has no window; write them by duoptic truth patterns, show and take them by other "
      "means"};
}
#endif

struct DecodeOptions {
  std::vector<std::string> folders, light;
  std::string rig, patterns, output;
  int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  bool quiet = false, json = false;
};

Result<Exit> decode(const DecodeOptions& options, const CLI::App& app) {
  if (!options.light.empty() && options.light.size() != 2)
    throw CLI::ValidationError("--light", "give it twice: the left picture, then the right one");
  LightFolders what{.folders = options.folders, .light = options.light, .threads = options.threads};
  if (!options.rig.empty()) {
    DUO_TRY_ASSIGN(what.rig, load_rig(options.rig));
  }
  DUO_TRY_ASSIGN(const LightCode code, load_light_code(options.patterns.empty() ? fs::path(options.folders[0]) / kLightCodeFile
                                                                                : fs::path(options.patterns)));
  const std::size_t patterns = light_patterns(code).size();
  Progress progress(app, static_cast<std::int64_t>(patterns * options.folders.size()), options.quiet);
  DUO_TRY_ASSIGN(const LightTruth truth, decode_light_folders(code, what, counted(progress)));
  progress.end();
  DUO_TRY(write_scene(truth, options.output));
  if (options.json)
    fmt::print("{}\n", json_of(truth, patterns, options.folders.size(), options.output));
  else if (!options.quiet)
    fmt::print("{}", text_of(truth, options.output));
  for (const std::string& warning : warnings_of(truth)) say(app, "warning: " + warning);
  return Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("truth", "True disparity of your own desk, by a projector's patterns");
  sub->require_subcommand(1);
  sub->footer(kFooter);
  const auto shown = std::make_shared<ShownOptions>();
  CLI::App* patterns = sub->add_subcommand("patterns", "Writes the patterns as pictures, to be shown by other means");
  add_size_option(*patterns, shown->code.screen, "Of the projector, px")->default_str("1920x1080");
  shown->add_to(*patterns);
  patterns->add_option("-o,--output", shown->folder, "Folder for the pictures")->type_name("DIR")->required();
  patterns->footer(kPatternsFooter);

  const auto recording = std::make_shared<RecordOptions>();
  CLI::App* record_app = sub->add_subcommand("record", "Shows all patterns on a display and records both cameras");
  record_app->add_option("LEFT", recording->input.left, "Left camera, or what gives both views")->required();
  record_app->add_option("RIGHT", recording->input.right, "Right camera");
  record_app->add_option("--rig", recording->input.rig, "Asks the cameras for pictures of its size")->type_name("FILE");
  recording->input.add_to(*record_app);
  record_app->add_option("--display", recording->display, "The projector among the displays, counted from 0")
      ->type_name("N")
      ->check(within(0, 63))
      ->capture_default_str();
  record_app->add_option("--average", recording->how.average, "Pictures per pattern, of which the mean is kept")
      ->type_name("N")
      ->check(within(1, 256))
      ->capture_default_str();
  record_app->add_option("--wait", recording->how.most_s, "For a pattern to be seen and to come to rest; more for slow cameras")
      ->type_name("S")
      ->check(within(0.1, 600.0))
      ->capture_default_str();
  recording->add_to(*record_app);
  record_app->add_option("-o,--output", recording->folder, "Folder for the pictures")->type_name("DIR")->required();
  record_app->footer(kRecordFooter);

  const auto decoding = std::make_shared<DecodeOptions>();
  CLI::App* decode_app = sub->add_subcommand("decode", "Makes a scene of the recorded pictures");
  decode_app->add_option("DIR", decoding->folders, "Recorded pictures; several: exposures of the same scene")->required();
  decode_app->add_option("--rig", decoding->rig, "Calibration; without it the pictures are taken as rectified")
      ->type_name("FILE");
  decode_app->add_option("--patterns", decoding->patterns, "The patterns.json of what was shown; without it the first DIR's")
      ->type_name("FILE");
  decode_app
      ->add_option("--light", decoding->light,
                   "Raw pictures of the scene in ordinary light, left then right; without it those of the black pattern")
      ->type_name("FILE")
      ->allow_extra_args(false);
  decode_app->add_option("--threads", decoding->threads, "Number of threads; the result does not depend on it")
      ->check(within(1, 256))
      ->capture_default_str();
  decode_app->add_option("-o,--output", decoding->output, "Folder for the scene")->type_name("DIR")->required();
  decode_app->add_flag("--json", decoding->json, "Print the summary as JSON");
  decode_app->add_flag("--quiet", decoding->quiet, "Print nothing but errors and warnings");
  decode_app->footer(kDecodeFooter);
  return {sub, [=]() -> Result<Exit> {
            if (patterns->parsed()) return write_patterns(*shown, *patterns);
            if (record_app->parsed()) return record(*recording, *record_app);
            return decode(*decoding, *decode_app);
          }};
}

}  // namespace duo::app::truth
