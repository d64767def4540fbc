#include "duoptic/player.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <filesystem>

#include "core/check.h"
#include "core/clock.h"
#include "duoptic/one_pair.h"

namespace duo {
namespace {

/// "duoptic_2026-05-31_14-03-59.mkv" in the working folder, by the user's time; a name that no file has.
std::string dated_name(const std::string& ending) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  std::array<char, 64> stem_text{};
  std::strftime(stem_text.data(), stem_text.size(), "duoptic_%Y-%m-%d_%H-%M-%S", &local);
  const std::string stem = stem_text.data();
  std::error_code ignored;
  std::string name = stem + ending;
  for (int i = 2; std::filesystem::exists(name, ignored); ++i) name = fmt::format("{}_{}{}", stem, i, ending);
  return name;
}

double now_ms() { return static_cast<double>(wall_ns()) * 1e-6; }

}  // namespace

Result<std::unique_ptr<Player>> Player::open(PlayerSetup setup, std::unique_ptr<PairSource> pairs) {
  DUO_CHECK(!setup.pipeline.tracker.empty());
  DUO_CHECK(setup.open);
  std::unique_ptr<Player> player(new Player(std::move(setup)));
  DUO_TRY_ASSIGN(Pipeline pipeline, Pipeline::open(std::move(pairs), std::move(player->setup_.pipeline)));
  player->rig_ = *pipeline.setup().rig;
  player->parameters_ = pipeline.setup().parameters;
  player->skew_ = SkewWatch(pipeline.header().rectified.baseline_m);
  player->still_ = pipeline.still();
  player->count_ = pipeline.count();
  player->status_.loop = player->setup_.loop;
  const SinkTargets& sinks = player->setup_.sinks;
  DUO_TRY_ASSIGN(const auto notes, sinks.add_all_to(pipeline));
  for (const std::string& note : notes) player->setup_.say("warning: " + note);
  for (const auto& names : sinks.targets)
    player->status_.outputs.push_back({names.empty() ? "" : names.back(), !names.empty(), 0});
  player->pipeline_.emplace(std::move(pipeline));
  DUO_TRY_ASSIGN(player->thread_,
                 Worker::start("show the source", [p = player.get()](const std::stop_token& stop) { return p->run(stop); }));
  return player;
}

Player::~Player() {
  thread_.ask_to_stop();
  wishes_.close();
}

std::shared_ptr<const Shown> Player::newest() const {
  const std::lock_guard lock(mutex_);
  return newest_;
}

PlayerStatus Player::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void Player::play(bool on) {
  post([this, on] {
    const std::lock_guard lock(mutex_);
    if (status_.state == PlayState::kEnded) return;
    status_.state = on ? PlayState::kPlaying : PlayState::kPaused;
    next_ms_ = last_ms_ = 0;  // time stood still
  });
}

void Player::step() {
  post([this] { step_ = true; });
}

void Player::restart() {
  post([this] {
    if (live() || !reopen()) return;
    const std::lock_guard lock(mutex_);
    status_.state = PlayState::kPlaying;
  });
}

void Player::seek(std::int64_t number) {
  post([this, number] {
    if (live() || still_ || failed_ || !reopen(number)) return;
    step_ = true;
    next_ms_ = last_ms_ = 0;
    const std::lock_guard lock(mutex_);
    if (status_.state == PlayState::kEnded) status_.state = PlayState::kPaused;
  });
}

void Player::set_speed(double factor) {
  post([this, factor] { speed_ = factor; });
}

void Player::loop(bool on) {
  post([this, on] {
    {
      const std::lock_guard lock(mutex_);
      status_.loop = on;
      if (!on || status_.state != PlayState::kEnded || failed_) return;
      status_.state = PlayState::kPlaying;
    }
    reopen();
  });
}

void Player::select(const std::vector<Selection>& selections) {
  post([this, selections] {
    if (!pipeline_->pair()) return;
    const bool first = pipeline_->people().empty();
    if (const auto selected = pipeline_->select(selections); !selected) {
      fail(selected.error(), false);
      const std::lock_guard lock(mutex_);
      ++status_.refused;
      return;
    }
    selected_.emplace(pipeline_->tracked().number, selections);
    {
      const std::lock_guard lock(mutex_);
      status_.problem.clear();
    }
    if (first) write();  // else this frame has its line already
    show(0);
  });
}

void Player::forget_people() {
  post([this] {
    pipeline_->forget();
    selected_.reset();
    if (pipeline_->pair()) show(0);
  });
}

void Player::set(const std::vector<std::pair<std::string, double>>& parameters) {
  post([this, parameters] {
    if (const auto set = pipeline_->set(parameters); !set) return fail(set.error(), false);
    if (!pipeline_->pair()) return;
    if (still_ && selected_) static_cast<void>(pipeline_->select(selected_->second));
    show(0);
  });
}

void Player::record(bool on) {
  post([this, on] {
    if (!on) return pipeline_->stop_recording();
    if (still_ || resting()) return;
    // What went wrong is in its status, which the window shows.
    static_cast<void>(
        pipeline_->record(dated_name(".mkv"), {.frame_s = header().frame_s, .rig = rig_, .date = live() ? date_now() : ""}));
  });
}

void Player::put_out(std::size_t kind, bool on, const std::string& target) {
  post([this, kind, on, target] {
    const SinkKind& what = sink_kinds()[kind];
    OutputStatus output = status().outputs[kind];
    if (on == output.on) return;
    if (on) {
      output = {what.is_file() ? dated_name(what.target) : target, true, 0};
      const auto added = setup_.sinks.add_to(*pipeline_, what, output.name);
      if (!added) return fail(added.error(), false);
      const std::lock_guard lock(mutex_);
      status_.problem = *added;
    } else {
      output.on = false;
      if (const auto finished = pipeline_->finish_sink(output.name); !finished) fail(finished.error(), false);
    }
    const std::lock_guard lock(mutex_);
    status_.outputs[kind] = output;
  });
}

void Player::check_rig() {
  post([this] {
    if (!pipeline_->pair()) return;
    {
      const std::lock_guard lock(mutex_);
      if (std::exchange(status_.checking_rig, true)) return;
    }
    const Pair& last = *pipeline_->pair();
    const auto pair = std::make_shared<Pair>(Pair{{last.left.pixels.clone()}, {last.right.pixels.clone()}, last.sequence});
    auto checking = Worker::start("look at the pair", [this, pair](const std::stop_token&) -> Result<void> {
      const auto one = one_pair(std::move(*pair));
      auto health = scene_health(rig_, *one, 1);
      {
        const std::lock_guard lock(mutex_);
        status_.health = std::move(health);
        status_.checking_rig = false;
      }
      setup_.on_news();
      return {};
    });
    if (checking) {
      checking_ = std::move(*checking);
      return;
    }
    fail(checking.error(), false);
    const std::lock_guard lock(mutex_);
    status_.checking_rig = false;
  });
}

Result<Next> Player::finish() {
  thread_.ask_to_stop();
  wishes_.close();
  const Result<void> ended = thread_.join();
  if (checking_.started()) static_cast<void>(checking_.join());
  pipeline_->stop_recording();
  const Result<void> outputs = pipeline_->finish_sinks();
  DUO_TRY(ended);
  if (failed_) return *failed_;
  DUO_TRY(outputs);
  if (const auto failure = pipeline_->recording_failure()) return *failure;
  return cut_ ? Next::kCut : Next::kEnd;
}

bool Player::resting() const {
  const std::lock_guard lock(mutex_);
  return status_.state == PlayState::kEnded;
}

/// Until the next frame is wanted; none while nothing plays.
std::optional<double> Player::due_in_ms() const {
  const std::lock_guard lock(mutex_);
  if (step_ && status_.state == PlayState::kPaused) return 0;
  if (status_.state != PlayState::kPlaying) return std::nullopt;
  return step_ || live() ? 0 : std::max(0.0, next_ms_ - now_ms());
}

Result<void> Player::run(const std::stop_token& stop) {
  constexpr double kIdle_ms = 1000;
  for (std::function<void()> wish; !stop.stop_requested();) {
    const std::chrono::duration<double, std::milli> wait(due_in_ms().value_or(kIdle_ms));
    DUO_TRY_ASSIGN(const Taken taken, wishes_.take(wish, std::chrono::duration_cast<std::chrono::nanoseconds>(wait)));
    if (taken == Taken::kClosed) break;
    if (taken == Taken::kValue)
      wish();
    else if (due_in_ms() == 0.0)
      advance();
    else
      continue;
    setup_.on_news();
  }
  return {};
}

/// The next frame: track it, show it, write it.
void Player::advance() {
  const Result<Next> next = pipeline_->next();
  if (!next) return fail(next.error(), true);
  if (const std::string& news = pipeline_->rig_news(); !news.empty()) setup_.say("warning: " + news);
  {
    const std::lock_guard lock(mutex_);
    if (const auto& fit = pipeline_->rig_fit()) status_.rig_news = fit->what;
    if (!pipeline_->rig_news().empty()) status_.rig_news = pipeline_->rig_news();
    status_.silent = *next == Next::kNothing;
    status_.dropped = pipeline_->dropped();
    if (live()) status_.event = pipeline_->warning();
    if (status_.event.empty() && now_ms() < passing_until_ms_) status_.event = passing_words_;
  }
  if (*next == Next::kNothing) return;  // a step is still to come
  step_ = false;
  if (*next != Next::kNew) return at_end(*next);
  const double now = now_ms();
  const double interval = last_ms_ > 0 ? now - last_ms_ : 0;
  last_ms_ = now;
  // Late frames shift all that follow: none is left out, and none is hurried.
  const double frame_ms = 1000 * header().frame_s / speed_;
  next_ms_ = std::max(next_ms_, now - frame_ms) + frame_ms;

  const TrackedFrame frame = pipeline_->tracked();
  if (!live() && selected_ && selected_->first == frame.number) static_cast<void>(pipeline_->select(selected_->second));
  if (!pipeline_->people().empty()) write();
  std::string words = pipeline_->event();
  if (const auto warning = live() ? skew_.see(frame) : std::nullopt) words += *warning;
  if (!words.empty()) {
    constexpr double kRead_ms = 10'000;
    passing_words_ = std::move(words);
    passing_until_ms_ = now + kRead_ms;
  }
  show(interval);
}

void Player::at_end(Next end) {
  pipeline_->stop_recording();
  cut_ = cut_ || end == Next::kCut;
  warning_ = pipeline_->warning();
  {
    const std::lock_guard lock(mutex_);
    status_.problem = warning_;
    if (!status_.loop || live() || !pipeline_->pair()) {
      status_.state = PlayState::kEnded;
      return;
    }
  }
  reopen();
}

/// From the first pair again, or another. What was selected is selected again when its frame comes.
bool Player::reopen(std::int64_t first) {
  pipeline_->stop_recording();
  pipeline_->close_source();  // before another: a file may be a device
  const auto restart = [this, first]() -> Result<void> {
    DUO_TRY_ASSIGN(Input input, setup_.open());
    return pipeline_->restart(std::move(input.pairs), first);
  };
  const Result<void> restarted = restart();
  if (!restarted) fail(restarted.error(), true);
  return restarted.has_value();
}

void Player::write() {
  const Result<void> written = pipeline_->write();
  {
    const std::lock_guard lock(mutex_);
    for (OutputStatus& output : status_.outputs) {
      output.on = output.on && pipeline_->has_sink(output.name);
      output.frames += output.on;
    }
  }
  if (!written) fail(written.error(), false);
}

void Player::show(double interval_ms) {
  const TrackedFrame now = pipeline_->tracked();
  auto shown = std::make_shared<Shown>();
  shown->number = now.number;
  shown->t_s = now.t_s;
  shown->left = {pipeline_->pair(), &pipeline_->pair()->left};
  shown->frame = pipeline_->frame();
  shown->people.assign(pipeline_->people().begin(), pipeline_->people().end());
  shown->times = pipeline_->times();
  shown->interval_ms = interval_ms;
  shown->skew_ms = static_cast<double>(shown->frame->skew_ns) * 1e-6;
  shown->latency_ms = live() ? now_ms() - static_cast<double>(shown->left->t_ns) * 1e-6
                             : shown->times.engine_ms + (shown->people.empty() ? 0 : shown->times.tracker_ms);
  const std::lock_guard lock(mutex_);
  newest_ = std::move(shown);
}

/// Says it in the window; `for_good`: nothing more comes.
void Player::fail(const Error& error, bool for_good) {
  if (for_good) pipeline_->stop_recording();
  if (for_good || error.code == ErrorCode::kWriteFailed) failed_ = failed_.value_or(error);
  const std::lock_guard lock(mutex_);
  status_.problem = error.what;
  if (for_good) status_.state = PlayState::kEnded;
}

}  // namespace duo
