// duoptic detect: people in a picture or a video, the points of their bodies and hands.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "command.h"
#include "duoptic/detector.h"
#include "duoptic/interrupt.h"
#include "duoptic/output_set.h"
#include "duoptic/paint.h"
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
  std::string input, folder, model = "full", engine = "simd";
  int threads = static_cast<int>(std::thread::hardware_concurrency());
  bool hands = false, json = false, quiet = false;
};

const std::vector<std::pair<std::string, BodyModel>> kModels = {
    {"lite", BodyModel::kLite}, {"full", BodyModel::kFull}, {"heavy", BodyModel::kHeavy}};

/// Hundredths: what lies below is noise of the picture.
double rounded(double value, double steps) { return std::round(value * steps) / steps; }

nlohmann::ordered_json json_of(const SeenHand& hand) {
  nlohmann::ordered_json points;
  for (std::size_t i = 0; i < kHandPoints; ++i)
    points[std::string(hand_point_name(i))] = {rounded(hand.points[i].x_px(), 100), rounded(hand.points[i].y_px(), 100)};
  return {{"score", rounded(hand.score_q15 / 32768.0, 1e4)}, {"points", points}};
}

nlohmann::ordered_json json_of(const SeenPerson& person) {
  nlohmann::ordered_json points;
  for (std::size_t i = 0; i < kBodyPoints; ++i) {
    const SeenPoint& point = person.body.points[i];
    points[std::string(name_of(static_cast<BodyPoint>(i)))] = {rounded(point.x_px(), 100), rounded(point.y_px(), 100),
                                                               rounded(point.visibility(), 1e4)};
  }
  const Window& box = person.box_px;
  nlohmann::ordered_json out = {{"box_px", {box.x, box.y, box.width, box.height}},
                                {"score", rounded(person.body.score_q15 / 32768.0, 1e4)},
                                {"points", points}};
  if (person.left_hand) out["hands"]["left"] = json_of(*person.left_hand);
  if (person.right_hand) out["hands"]["right"] = json_of(*person.right_hand);
  return out;
}

std::string line_of(std::span<const SeenPerson> people) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const SeenPerson& person : people) all.push_back(json_of(person));
  return nlohmann::ordered_json{{"people", all}}.dump();
}

Result<Exit> run(const Options& options, const CLI::App& app) {
  DetectorOptions wish;
  for (const auto& [name, model] : kModels)
    if (name == options.model) wish.body = model;
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
    if (options.json) fmt::print("{}\n", line_of(people));
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
  std::vector<std::string> models;
  for (const auto& [name, model] : kModels) models.push_back(name);
  sub->add_option("--model", options->model, "How large a network: lite, full, or heavy, which is made on demand")
      ->check(CLI::IsMember(models))
      ->capture_default_str();
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
