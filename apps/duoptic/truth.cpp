// duoptic truth: the true disparity of one's own desk, by structured light.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "duoptic/interrupt.h"
#include "duoptic/output_set.h"
#include "duoptic/sink.h"
#include "duoptic/structured_light.h"
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

constexpr const char* kCodeFile = "patterns.json";

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

Result<void> write_code(const LightCode& code, OutputSet& out) {
  const fs::path path = out / kCodeFile;
  std::ofstream file(path, std::ios::binary);
  if ((file << json_from_light_code(code)).flush()) return {};
  return Error{ErrorCode::kWriteFailed, fmt::format("cannot write {}", kCodeFile)};
}

nlohmann::json to_json(const LightCode& code, const std::string& folder) {
  return {{"folder", folder},
          {"patterns", light_patterns(code).size()},
          {"screen", {code.screen.width, code.screen.height}},
          {"period_px", code.period_px}};
}

Result<Exit> write_patterns(const ShownOptions& options, const CLI::App& app) {
  DUO_TRY(check_light_code(options.code));
  const auto patterns = light_patterns(options.code);
  DUO_TRY_ASSIGN(OutputSet out, OutputSet::open(options.folder));
  {
    Progress progress(app, static_cast<std::int64_t>(patterns.size()), options.quiet);
    for (std::size_t i = 0; i < patterns.size(); ++i) {
      if (Interrupt::asked()) return stopped("all patterns were drawn");
      DUO_TRY(write_png(draw_pattern(options.code, patterns[i], options.white()), out / fmt::format("pattern_{:03}.png", i)));
      progress.frame(static_cast<std::int64_t>(i) + 1);
    }
  }
  DUO_TRY(write_code(options.code, out));
  DUO_TRY(out.publish());
  if (options.json)
    fmt::print("{}\n", to_json(options.code, options.folder).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  else if (!options.quiet)
    fmt::print("{}: {} patterns of {}x{}\n", options.folder, patterns.size(), options.code.screen.width,
               options.code.screen.height);
  return Exit::kOk;
}

struct RecordOptions : ShownOptions {
  std::string left, right, rig;
  InputOptions input;
  LightRecording how;
  int display = 0;
};

#ifdef DUO_VIEWER
Result<Exit> record(RecordOptions options, const CLI::App& app) {
  std::optional<Rig> rig;
  if (!options.rig.empty()) {
    DUO_TRY_ASSIGN(rig, load_rig(options.rig));
  }
  DUO_TRY_ASSIGN(Input input, open_input(options.left, options.right, rig, options.input));
  if (!input.pairs->live())
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot record patterns from {}: files do not see the screen; give two cameras, "
                             "or decode pictures that were taken of the patterns",
                             options.left)};
  DUO_TRY_ASSIGN(view::PatternScreen shown, view::open_pattern_screen(options.display));
  options.code.screen = shown.size;
  options.how.white = options.white();
  const auto count = static_cast<std::int64_t>(light_patterns(options.code).size());
  DUO_TRY_ASSIGN(OutputSet out, OutputSet::open(options.folder));
  Progress progress(app, count, options.quiet);
  DUO_TRY(record_light(*input.pairs, options.code, options.how, *shown.screen,
                       [&](std::size_t pattern, const Pair& pair) -> Result<void> {
                         progress.frame(static_cast<std::int64_t>(pattern) + 1);
                         DUO_TRY(write_png(pair.left.pixels, out / light_file_name(true, pattern)));
                         return write_png(pair.right.pixels, out / light_file_name(false, pattern));
                       }));
  DUO_TRY(write_code(options.code, out));
  DUO_TRY(out.publish());
  if (options.json)
    fmt::print("{}\n", to_json(options.code, options.folder).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
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

double share_percent(std::int64_t part, std::int64_t all) {
  return 100.0 * static_cast<double>(part) / static_cast<double>(std::max<std::int64_t>(all, 1));
}

nlohmann::json to_json(const LightCounts& c) {
  return {{"pixels", c.pixels},
          {"known_percent", share_percent(c.known, c.pixels)},
          {"unlit_percent", share_percent(c.unlit, c.pixels)},
          {"saturated_percent", share_percent(c.saturated, c.pixels)},
          {"uncertain_percent", share_percent(c.uncertain, c.pixels)}};
}

Result<Picture> load_one(const std::string& path) {
  DUO_TRY_ASSIGN(const auto source, open_source(path));
  Picture picture;
  DUO_TRY_ASSIGN(const Next next, source->next(picture));
  if (next == Next::kNew) return picture;
  return Error{ErrorCode::kBadInput, fmt::format("cannot use {}: it has no picture", path)};
}

/// Dark rooms are best for patterns, but leave matchers nothing to see.
bool is_dark(const Image<Rgb8>& picture) {
  constexpr double kDark = 25;
  double sum = 0;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) sum += picture.at(y, x).g;
  return sum < kDark * picture.width() * picture.height();
}

void print(const LightTruth& truth, std::size_t patterns, const DecodeOptions& options) {
  const Size size = truth.disparity_px.size();
  const double covered = share_percent(truth.matched, truth.inside);
  if (options.json) {
    const nlohmann::json out = {{"scene", options.output},
                                {"width", size.width},
                                {"height", size.height},
                                {"patterns", patterns},
                                {"exposures", options.folders.size()},
                                {"disparities", truth.matched},
                                {"coverage_percent", covered},
                                {"contradicting", truth.contradicting},
                                {"rows_px", truth.rows_px},
                                {"left", to_json(truth.left)},
                                {"right", to_json(truth.right)}};
    fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return;
  }
  if (options.quiet) return;
  for (const auto& [name, c] : {std::pair{"left", truth.left}, {"right", truth.right}})
    fmt::print("{:<6} {:5.1f} % lit and told apart, {:.1f} % too dark, {:.1f} % too bright, {:.1f} % in doubt\n", name,
               share_percent(c.known, c.pixels), share_percent(c.unlit, c.pixels), share_percent(c.saturated, c.pixels),
               share_percent(c.uncertain, c.pixels));
  fmt::print("truth  {:5.1f} % of the left picture; rows disagree by {:.2f} px at the median; {}x{}, written to {}\n", covered,
             truth.rows_px, size.width, size.height, options.output);
}

Result<Exit> decode(const DecodeOptions& options, const CLI::App& app) {
  if (!options.light.empty() && options.light.size() != 2)
    throw CLI::ValidationError("--light", "give it twice: the left picture, then the right one");
  std::optional<Rig> rig;
  if (!options.rig.empty()) {
    DUO_TRY_ASSIGN(rig, load_rig(options.rig));
  }
  const fs::path code_path = options.patterns.empty() ? fs::path(options.folders[0]) / kCodeFile : fs::path(options.patterns);
  DUO_TRY_ASSIGN(const LightCode code, load_light_code(code_path));
  std::vector<LightFiles> files;
  for (const std::string& folder : options.folders) {
    DUO_TRY_ASSIGN(const auto found, find_light_files(folder, code));
    files.insert(files.end(), found.begin(), found.end());
  }
  std::optional<LightDecoder> decoder;
  Pair pair;
  {
    Progress progress(app, static_cast<std::int64_t>(files.size()), options.quiet);
    for (std::size_t i = 0; i < files.size(); ++i) {
      if (Interrupt::asked()) return stopped("all pictures were decoded");
      DUO_TRY_ASSIGN(pair.left, load_one(files[i].left));
      DUO_TRY_ASSIGN(pair.right, load_one(files[i].right));
      if (!decoder) {
        DUO_TRY_ASSIGN(decoder, LightDecoder::open(code, rig, pair.left.pixels.size(), options.threads));
      }
      if (const auto added = decoder->add(pair); !added)
        return Error{added.error().code, fmt::format("{}: {}", files[i].left.parent_path().string(), added.error().what)};
      progress.frame(static_cast<std::int64_t>(i) + 1);
    }
  }
  const bool other_light = !options.light.empty();
  if (other_light) {
    DUO_TRY_ASSIGN(pair.left, load_one(options.light[0]));
    DUO_TRY_ASSIGN(pair.right, load_one(options.light[1]));
  }
  DUO_TRY_ASSIGN(const LightTruth truth, decoder->truth(other_light ? &pair : nullptr));
  DUO_TRY(write_scene(truth, options.output));
  print(truth, light_patterns(code).size(), options);
  constexpr double kRowsMatter_px = 0.3;
  if (std::abs(truth.rows_px) > kRowsMatter_px)
    say(app,
        fmt::format("warning: the right view shows everything {:.2f} px {} than the left one: the rig does not fit; correct it "
                    "by duoptic rig refine, then decode again",
                    std::abs(truth.rows_px), truth.rows_px > 0 ? "lower" : "higher"));
  if (is_dark(truth.pair.left.pixels))
    say(app, "warning: left.png is dark, as the room was; give pictures of the same scene in ordinary light by --light");
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
  record_app->add_option("LEFT", recording->left, "Left camera, or what gives both views")->required();
  record_app->add_option("RIGHT", recording->right, "Right camera");
  record_app->add_option("--rig", recording->rig, "Asks the cameras for pictures of its size")->type_name("FILE");
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
