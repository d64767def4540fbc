// duoptic detect: people in a picture or a video, the points of their bodies and hands.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <thread>

#include "command.h"
#include "duoptic/interrupt.h"
#include "duoptic/output_set.h"
#include "duoptic/paint.h"
#include "duoptic/reports.h"
#include "duoptic/sink.h"
#include "duoptic/source.h"
#include "progress.h"

namespace duo::app::detect {
namespace {

constexpr char kFooter[] =
    "Finds up to eight people, near ones in the whole picture and far ones in its parts, and 33 points of each body, with\n"
    "--hands also 21 of each hand; docs/detect.md names them. In a video people are followed from picture to picture.\n"
    "The results are integers: the same on every processor and with any number of threads.\n"
    "-o writes DIR/people.png, of a video DIR/frame_000000.png and so on: left limbs orange, right ones blue, pale where "
    "hidden.\n"
    "--json prints a line for each picture: {\"people\":[{\"box_px\":[x,y,w,h],\"score\":s,\n"
    "\"points\":{\"left_shoulder\":[x_px,y_px,visibility],...}}]}; with --hands also "
    "\"hands\":{\"left\":{\"score\":s,\"points\":{...}}}.\n\n"
    "Examples:\n"
    "  duoptic detect people.jpg -o out\n"
    "  duoptic detect walk.mp4 --model lite --json > people.jsonl\n"
    "  duoptic detect wave.avi --hands -o out";

struct Options {
  std::string input, folder, engine = "simd";
  BodyModel model = BodyModel::kFull;
  int threads = static_cast<int>(std::thread::hardware_concurrency());
  bool hands = false, json = false, quiet = false;
};

Result<Exit> run(const Options& options, const CLI::App& app) {
  DetectorOptions wish;
  wish.body = options.model;
  wish.hands = options.hands;
  wish.plain = options.engine == "ref";
  if (options.engine.starts_with("vulkan"))
    wish.device = options.engine.substr(std::min<std::size_t>(options.engine.size(), 7));
  wish.threads = options.threads;
  DUO_TRY_ASSIGN(const std::unique_ptr<Detector> detector, make_detector(wish));
  DUO_TRY_ASSIGN(const std::unique_ptr<Source> source, open_source(options.input));
  PeopleFinder finder(*detector, {.hands = options.hands});
  Progress progress(app, source->count(), options.quiet || source->still());
  if (source->live()) Interrupt::is_the_end();

  Next end = Next::kEnd;
  std::int64_t pictures = 0, with_people = 0;
  std::size_t most = 0;
  for (Picture picture;; ++pictures) {
    do {
      DUO_TRY_ASSIGN(end, source->next(picture));
    } while (end == Next::kNothing && !Interrupt::asked());
    if (end != Next::kNew || Interrupt::asked()) break;
    const auto people = source->still() ? finder.look(picture.pixels) : finder.follow(picture.pixels);
    with_people += !people.empty();
    most = std::max(most, people.size());
    if (options.json) fmt::print("{}\n", json_of(people));
    if (!options.folder.empty()) {
      draw_people(people, picture.pixels);
      DUO_TRY_ASSIGN(OutputSet out, OutputSet::open(options.folder));
      DUO_TRY(write_png(std::as_const(picture.pixels).view(),
                        out / (source->still() ? "people.png" : fmt::format("frame_{:06}.png", pictures))));
      DUO_TRY(out.publish());
    }
    progress.frame(pictures + 1);
  }
  if (!options.json && !options.quiet) {
    if (source->still())
      fmt::print("{} {}\n", most, most == 1 ? "person" : "people");
    else
      fmt::print("{} pictures, people in {}, {} at most at once\n", pictures, with_people, most);
    if (!options.folder.empty()) fmt::print("written to {}\n", options.folder);
  }
  if (end == Next::kCut)
    say(app, fmt::format("warning: {} was cut short; its {} whole pictures were looked at", options.input, pictures));
  return end == Next::kCut ? Exit::kCut : Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("detect", "Find people in a picture or a video, and the points of their bodies and hands");
  const auto options = std::make_shared<Options>();
  sub->add_option("INPUT", options->input, "A picture, a video, a camera or a stream")->required();
  sub->add_option("-o,--output", options->folder, "Write what was found over the pictures into a folder")->type_name("DIR");
  add_choice_option(*sub, "--model", options->model, kBodyModelNames,
                    "How large a network: lite, full, or heavy, which is made on demand");
  sub->add_flag("--hands", options->hands, "Find the points of hands, too");
  sub->add_option("--engine", options->engine,
                  "ref: plain loops, slow; simd: the processor's vectors; vulkan[:DEVICE]; the same results")
      ->check([](const std::string& engine) {
        const bool known = engine == "ref" || engine == "simd" || engine == "vulkan" || engine.starts_with("vulkan:");
        return known ? std::string() : fmt::format("'{}' is none of ref, simd, vulkan[:DEVICE]", engine);
      })
      ->capture_default_str();
  sub->add_option("--threads", options->threads, "Threads; results do not depend on them")
      ->check(within(1, 256))
      ->capture_default_str();
  sub->add_flag("--json", options->json, "Print what was found as JSON, a line for each picture");
  sub->add_flag("-q,--quiet", options->quiet, "Print no summary");
  sub->footer(kFooter);
  return {sub, [options, sub] { return run(*options, *sub); }};
}

}  // namespace duo::app::detect
