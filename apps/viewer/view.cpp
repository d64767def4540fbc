// duoptic view: a window on a source: depth, points, and persons in 3D from clicks on their joints.
#include <fmt/format.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "calibration_page.h"
#include "command.h"
#include "duoptic/frame_files.h"
#include "duoptic/interrupt.h"
#include "duoptic/player.h"
#include "duoptic/source_choice.h"
#include "input.h"
#include "panels.h"
#include "run_news.h"
#include "sidebar.h"
#include "sink_options.h"
#include "start.h"
#include "tracking_options.h"
#include "window.h"

namespace duo::app::view {
namespace {

constexpr char kFooter[] =
    "People are found and tracked by themselves. With --tracker arm click hand, elbow and shoulder in the left camera's "
    "picture,\n"
    "which stands still meanwhile; then the arm is tracked.\n"
    "Keys: F1 in the window shows them.\n"
    "Tracked frames are written and sent as track does, by the same options or the boxes in the window.\n\n"
    "Examples:\n"
    "  duoptic view                                                                  asks what to look at\n"
    "  duoptic view synthetic                                                        a rendered person, live\n"
    "  duoptic view camera:0 camera:2 --rig rig.json\n"
    "  duoptic view left.avi right.avi --rig rig.json --loop\n"
    "  duoptic view left.avi right.avi --rig rig.json --tracker arm -o arm.jsonl\n"
    "  duoptic view left.avi right.avi --rig rig.json --screenshot view.png --after 30    closes after that frame";

constexpr Size kWindow = {1440, 860};

constexpr std::pair<const char*, const char*> kKeys[] = {{"Space", "pause, play"},
                                                         {"Left, Right", "the frame before, the next one"},
                                                         {"Home", "play a file from its start"},
                                                         {"R", "record, stop"},
                                                         {"Backspace", "undo a click"},
                                                         {"P", "rectified pair in place of hue"},
                                                         {"Double click", "one panel alone, all of them"},
                                                         {"S", "points, depth and picture into files"},
                                                         {"F12", "window as PNG"},
                                                         {"F1", "these keys"},
                                                         {"Q", "close"}};

struct Options {
  InputOptions input;
  TrackingOptions tracking;
  SinkOptions sinks;
  RigCheck check = RigCheck::kTell;
  std::string screenshot;
  std::int64_t after = 0;
  bool loop = false, paused = false;
};

class Viewer {
 public:
  Viewer(const Options& options, Window& window, Player& player, Sidebar sidebar)
      : options_(options),
        window_(window),
        player_(player),
        panels_(player.header(), window.scale()),
        sidebar_(std::move(sidebar)),
        clicks_(player.header().skeletons, player.asks_for_clicks()) {}

  /// Until the window is closed.
  Result<void> run() {
    constexpr double kIdle_s = 0.1;
    if (options_.paused)
      player_.step();
    else
      player_.play(true);
    while (!window_.closing() && !Interrupt::asked() && !done_) {
      // ImGui 1.86 sees a second click only when a frame came between both.
      Window::wait(ImGui::IsAnyMouseDown() ? 0.01 : kIdle_s);
      if (!window_.begin()) continue;
      take_newest();
      if (shown_) DUO_TRY(panels_.show(shown_));
      DUO_TRY(draw());
      window_.end();
      DUO_TRY(keep_screenshot());
      DUO_TRY(check_end());
    }
    return {};
  }

 private:
  void take_newest() {
    // Clicks that were refused are asked for again; the side says why.
    if (const int refused = player_.status().refused; refused != std::exchange(refused_, refused))
      clicks_.start(clicks_.choice());
    const auto newest = player_.newest();
    if (!newest || newest == shown_) return;
    shown_ = newest;
    sidebar_.add(*shown_);
    if (!options_.screenshot.empty() && shown_->number >= options_.after) window_.want_screenshot();
  }

  Result<void> draw() {
    const ImGuiIO& io = ImGui::GetIO();
    const float margin = 8 * window_.scale(), beside = std::min(320 * window_.scale(), 0.38f * io.DisplaySize.x);
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize(io.DisplaySize);
    ImGui::Begin("duoptic", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav);
    DUO_TRY_ASSIGN(
        const auto click,
        panels_.draw({margin, margin}, {io.DisplaySize.x - beside - 2 * margin, io.DisplaySize.y - margin}, clicks_));
    if (click) take_click(*click);
    hold_while_clicking();
    ImGui::SetCursorScreenPos({io.DisplaySize.x - beside - margin, margin});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {10 * window_.scale(), 10 * window_.scale()});
    ImGui::BeginChild("controls", {beside, io.DisplaySize.y - 2 * margin}, false, ImGuiWindowFlags_AlwaysUseWindowPadding);
    if (sidebar_.draw(player_, clicks_, panels_.choices(), shown_.get(), note_)) window_.want_screenshot();
    ImGui::EndChild();
    ImGui::PopStyleVar();
    ImGui::End();
    draw_keys();
    take_keys();
    if (!ImGui::IsAnyMouseDown()) put_title();  // who reads it may click
    return {};
  }

  void put_title() {
    const std::string doing = !shown_                   ? ""
                              : clicks_.wanted()        ? ": " + clicks_.prompt()
                              : !shown_->people.empty() ? ": tracking"
                                                        : "";
    window_.set_title("duoptic view" + doing + (player_.recording().on ? ", recording" : ""));
  }

  void take_click(ClickAt click) {
    if (!clicks_.add(click.x_px, click.y_px)) return;
    player_.select(clicks_.selections());
    clicks_.stop();
  }

  /// The picture stands still from the first click, when its button goes down, to the last: all are then of one frame.
  void hold_while_clicking() {
    const bool hold = clicks_.wanted() && (panels_.pressed() || !clicks_.made().empty());
    if (hold == std::exchange(held_, hold)) return;
    if (hold) resume_ = player_.status().state == PlayState::kPlaying;
    if (resume_) player_.play(!hold);
  }

  void take_keys() {
    for (const int key : window_.keys()) {
      const PlayState state = player_.status().state;
      if (key == GLFW_KEY_SPACE) player_.play(state != PlayState::kPlaying);
      if (key == GLFW_KEY_RIGHT && state == PlayState::kPlaying) player_.play(false);
      if (key == GLFW_KEY_RIGHT) player_.step();
      if (key == GLFW_KEY_LEFT && shown_ && !player_.live()) {
        player_.play(false);
        player_.seek(std::max<std::int64_t>(0, shown_->number - 1));
      }
      if (key == GLFW_KEY_P) panels_.choices().rectified_pair = !panels_.choices().rectified_pair;
      if (key == GLFW_KEY_ESCAPE) panels_.enlarge(std::nullopt);
      if (key == GLFW_KEY_BACKSPACE && clicks_.wanted()) clicks_.undo();
      if (key == GLFW_KEY_R) player_.record(!player_.recording().on);
      if (key == GLFW_KEY_HOME) player_.restart();
      if (key == GLFW_KEY_F12) window_.want_screenshot();
      if (key == GLFW_KEY_F1) help_ = !help_;
      if (key == GLFW_KEY_S && shown_) keep_points();
      if (key == GLFW_KEY_Q) done_ = true;
    }
  }

  /// What is shown: points as duoptic_view_001.ply, and beside them duoptic_view_001_depth.png and _left_rectified.png.
  void keep_points() {
    const std::filesystem::path points = free_name(".ply");
    FrameFiles files{.outputs = {FrameOutput::kDepth, FrameOutput::kPicture, FrameOutput::kCloud}};
    files.cloud.metric = player_.header().metric;
    const auto written = write_frame(*shown_->frame, player_.header().rectified, files, [&](const std::string& name) {
      return name.ends_with(".ply") ? points : std::filesystem::path(points.stem().string() + "_" + name);
    });
    note_ = written ? "written: " + points.string() + ", and its PNGs" : written.error().what;
  }

  void draw_keys() const {
    if (!help_) return;
    ImGui::SetNextWindowPos({40 * window_.scale(), 60 * window_.scale()});
    ImGui::Begin("Keys", nullptr,
                 ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings);
    for (const auto& [key, does] : kKeys) {
      ImGui::TextUnformatted(key);
      ImGui::SameLine(110 * window_.scale());
      ImGui::TextDisabled("%s", does);
    }
    ImGui::End();
  }

  Result<void> keep_screenshot() {
    const auto picture = window_.screenshot();
    if (!picture) return {};
    const bool asked = !options_.screenshot.empty() && shown_ && shown_->number >= options_.after;
    const std::filesystem::path path = asked ? options_.screenshot : free_name(".png");
    const auto written = write_png(*picture, path);
    note_ = written ? "written: " + path.string() : written.error().what;
    if (!asked) return {};
    done_ = true;
    return written;
  }

  /// A screenshot of a frame that never comes.
  Result<void> check_end() const {
    if (options_.screenshot.empty() || done_ || !shown_ || player_.status().state != PlayState::kEnded) return {};
    const std::int64_t pairs = shown_->number + 1;
    if (pairs > options_.after || player_.newest() != shown_) return {};
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot take a screenshot of frame {}: {} ends after {} pairs, numbered from 0", options_.after,
                             options_.input.left, pairs)};
  }

  const Options& options_;
  Window& window_;
  Player& player_;
  Panels panels_;
  Sidebar sidebar_;
  Clicks clicks_;
  std::shared_ptr<const Shown> shown_;
  std::string note_;
  int refused_ = 0;  // selections, so far
  bool held_ = false, resume_ = false, done_ = false, help_ = false;
};

Result<std::unique_ptr<Window>> open_window() {
  DUO_TRY_ASSIGN(auto window, Window::open("duoptic view", kWindow));
  set_style(window->scale());
  return window;
}

/// In the window, which is opened where it is not; false when it was closed before a rig was saved.
Result<bool> calibrate(Options& options, std::unique_ptr<Window>& window, std::unique_ptr<PairSource> pairs) {
  if (!window) {
    DUO_TRY_ASSIGN(window, open_window());
  }
  InputOptions& source = options.input;
  while (true) {
    const auto again = [source] { return open_pairs(source.left, source.right, source.wish()); };
    const bool two = !source.right.empty();
    DUO_TRY_ASSIGN(const CalibrationEnd end,
                   CalibrationPage::run(*window, {source.left, two ? source.right : source.left, again, Window::wake},
                                        std::move(pairs), two));
    source.rig = end.rig;
    if (!end.swapped) return !end.rig.empty();
    std::swap(source.left, source.right);
    DUO_TRY_ASSIGN(Input input, source.open());
    pairs = std::move(input.pairs);
  }
}

/// What is named, with its rig; cameras and videos without one are calibrated first. Null when the window was closed.
Result<std::unique_ptr<Player>> open_player(Options& options, std::unique_ptr<Window>& window, const CLI::App& app) {
  DUO_TRY_ASSIGN(Input input, options.input.open());
  if (!input.rig && !input.pairs->still() && options.screenshot.empty()) {
    DUO_TRY_ASSIGN(const bool calibrated, calibrate(options, window, std::move(input.pairs)));
    if (!calibrated) return std::unique_ptr<Player>();
    DUO_TRY_ASSIGN(input, options.input.open());
  }
  static_cast<void>(options.sinks.on_stdout());  // two outputs there are a mistake
  TrackingOptions tracking = options.tracking.or_tracker("body");
  tracking.all_maps = true;
  PlayerSetup setup{
      .sinks = options.sinks, .loop = options.loop, .on_news = Window::wake, .say = [&app](const std::string& line) {
        say(app, line);
      }};
  DUO_TRY_ASSIGN(setup.pipeline, tracking.setup(input));
  setup.pipeline.frames.wants.depth = true;  // for who saves what is shown
  setup.pipeline.check = options.check;
  setup.open = [given = options.input, rig = input.rig] { return open_input(given.left, given.right, rig, given.wish()); };
  return Player::open(std::move(setup), std::move(input.pairs));
}

/// Until what was chosen can be shown; null when the window was closed.
Result<std::unique_ptr<Player>> choose_player(Options& options, std::unique_ptr<Window>& window, const CLI::App& app) {
  StartPage page(*window, options.input.rig);
  std::string problem;
  while (const auto choice = page.choose(problem)) {
    options.input.left = choice->left;
    options.input.right = choice->right;
    options.input.rig = choice->rig;
    auto player = open_player(options, window, app);
    if (player && *player) return player;
    problem = player ? "" : player.error().what;
  }
  return std::unique_ptr<Player>();
}

Result<Exit> run(Options options, const CLI::App& app) {
  Interrupt::is_the_end();         // it closes the window as its user would: lines are completed
  std::unique_ptr<Window> window;  // outlives the player, which wakes it
  std::unique_ptr<Player> player;
  if (options.input.left.empty()) {
    DUO_TRY_ASSIGN(window, open_window());
    DUO_TRY_ASSIGN(player, choose_player(options, window, app));
  } else {
    DUO_TRY_ASSIGN(player, open_player(options, window, app));
  }
  if (!player) return Exit::kOk;
  if (!window) {
    DUO_TRY_ASSIGN(window, open_window());
  }
  const InputOptions& source = options.input;
  remember_source({source.left, source.right, source.rig});
  DUO_TRY_ASSIGN(Sidebar sidebar,
                 Sidebar::make(fmt::format("{}{}{}", source.left, source.right.empty() ? "" : ", ", source.right),
                               options.tracking.engine, *player, window->device(), window->scale()));
  const Result<void> shown = Viewer(options, *window, *player, std::move(sidebar)).run();
  DUO_TRY_ASSIGN(const Next end, player->finish());
  DUO_TRY(shown);
  if (!player->warning().empty()) say(app, "warning: " + player->warning());
  return end == Next::kCut ? Exit::kCut : Exit::kOk;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("view", "A window: depth, points, and people in 3D; or an arm tracked from three clicks");
  const auto options = std::make_shared<Options>();
  sub->add_option("LEFT", options->input.left,
                  "Picture or video of the left camera, the camera itself (camera:0, /dev/video0, http://, rtsp://, gst:),\nor "
                  "synthetic; alone: both views side by side. Without it the window asks");
  sub->add_option("RIGHT", options->input.right, "The same of the right camera");
  sub->add_option("--rig", options->input.rig, "Calibration (our JSON, OpenCV's YAML or JSON); left out: the source's own");
  options->input.add_to(*sub);
  CLI::Option* loop = sub->add_flag("--loop", options->loop, "Start again at the end of a file");
  sub->add_flag("--paused", options->paused, "Wait at the first frame");
  options->sinks.add_to(*sub);
  CLI::Option* shot = sub->add_option("--screenshot", options->screenshot, "Write a PNG of the window, then close it")
                          ->type_name("FILE")
                          ->excludes(loop);
  sub->add_option("--after", options->after, "The frame of the screenshot")
      ->type_name("N")
      ->check(within(std::int64_t{0}, std::int64_t{1} << 40))
      ->needs(shot)
      ->capture_default_str();
  add_strict_option(*sub, options->check);
  options->tracking.add_to(*sub);
  sub->footer(kFooter);
  return {sub, [options, sub] { return run(*options, *sub); }};
}

}  // namespace duo::app::view
