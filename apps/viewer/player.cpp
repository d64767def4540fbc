#include "player.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "rig_report.h"

namespace duo::app::view {
namespace {

/// One pair, as a stream.
class OnePair final : public PairSource {
 public:
  explicit OnePair(Pair pair) : pair_(std::move(pair)), size_(pair_.left.pixels.size()) {}
  Size size() const override { return size_; }
  std::int64_t count() const override { return 1; }
  bool still() const override { return true; }
  Result<Next> next(Pair& into) override {
    if (given_) return Next::kEnd;
    given_ = true;
    into = std::move(pair_);
    return Next::kPicture;
  }
  std::string warning() const override { return {}; }

 private:
  Pair pair_;
  Size size_;
  bool given_ = false;
};

Picture copy_of(const Picture& picture) { return {picture.pixels.clone(), picture.t_ns, picture.sequence}; }

Result<ArmRun> open_run(const PlayerOptions& options, Recording& recording) {
  DUO_TRY_ASSIGN(Input input, open_input(options.left, options.right, options.rig));
  input.pairs = std::make_unique<Tap>(std::move(input.pairs), recording);
  ArmOptions arm = options.arm;
  arm.all_maps = true;
  return ArmRun::open(std::move(input), arm);
}

double now_ms() { return clock_ms(CLOCK_MONOTONIC); }

}  // namespace

Result<std::unique_ptr<Player>> Player::open(const PlayerOptions& options) {
  std::unique_ptr<Player> player(new Player(options));
  DUO_TRY_ASSIGN(ArmRun run, open_run(options, player->recording_));
  player->header_ = run.header();
  player->rig_ = run.rig();
  player->skew_ = SkewWatch(run.header().rectified.baseline_m);
  player->live_ = run.header().live;
  player->still_ = run.frames().still();
  player->count_ = run.frames().count();
  player->asks_for_clicks_ = !run.tracker().starts_by_itself();
  player->status_.loop = options.loop;
  if (!options.lines.empty()) {
    DUO_TRY_ASSIGN(player->lines_, make_json_lines(options.lines, run.header()));
  }
  player->run_.emplace(std::move(run));
  player->thread_ = std::thread([p = player.get()] { p->run(); });
  return player;
}

Player::~Player() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  wished_.notify_all();
  if (thread_.joinable()) thread_.join();
}

std::shared_ptr<const Shown> Player::newest() const {
  const std::lock_guard lock(mutex_);
  return newest_;
}

PlayerStatus Player::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void Player::post(std::function<void()> wish) {
  {
    const std::lock_guard lock(mutex_);
    wishes_.push_back(std::move(wish));
  }
  wished_.notify_all();
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
    if (live_ || !reopen()) return;
    const std::lock_guard lock(mutex_);
    status_.state = PlayState::kPlaying;
  });
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
    if (!has_frame_ || !run_) return;
    const auto selected = run_->select(selections);
    if (!selected) {
      fail(selected.error(), false);
      const std::lock_guard lock(mutex_);
      ++status_.refused;
      return;
    }
    selected_.emplace(static_cast<std::int64_t>(run_->frames().last().pair.sequence), selections);
    {
      const std::lock_guard lock(mutex_);
      status_.problem.clear();
    }
    const bool first = people_.empty();
    keep(*selected);
    if (first) write_line(run_->tracked(people_));  // else this frame has its line already
    show(0);
  });
}

void Player::forget_people() {
  post([this] {
    if (run_) run_->reset();
    selected_.reset();
    people_.clear();
    if (has_frame_) show(0);
  });
}

void Player::set(const std::vector<std::pair<std::string, double>>& parameters) {
  post([this, parameters] {
    // After the end nothing is matched any more: the next round has them.
    if (run_ && !resting()) {
      if (const auto set = run_->set(parameters); !set) return fail(set.error(), false);
      if (has_frame_) show(0);
    }
    options_.arm.engine.set.clear();
    for (const auto& [name, value] : parameters) options_.arm.engine.set.push_back(fmt::format("{}={}", name, value));
    if (!still_ || !reopen()) return;
    const std::lock_guard lock(mutex_);
    status_.state = PlayState::kPlaying;
  });
}

void Player::record(bool on) {
  post([this, on] {
    if (!on) return recording_.stop();
    if (still_ || resting()) return;
    // What went wrong is in its status, which the window shows.
    static_cast<void>(
        recording_.start(dated_recording_name(), {.frame_s = header_.frame_s, .rig = rig_, .date = live_ ? date_now() : ""}));
  });
}

void Player::check_rig() {
  post([this] {
    if (!has_frame_ || !run_) return;
    {
      const std::lock_guard lock(mutex_);
      if (std::exchange(status_.checking_rig, true)) return;
    }
    const Pair& last = run_->frames().last().pair;
    checking_ = std::async(
        std::launch::async,
        [this](Pair pair) {
          OnePair one(std::move(pair));
          auto health = scene_health(rig_, one, 1);
          {
            const std::lock_guard lock(mutex_);
            status_.health = std::move(health);
            status_.checking_rig = false;
          }
          options_.on_news();
        },
        Pair{copy_of(last.left), copy_of(last.right), last.sequence});
  });
}

Result<Exit> Player::finish() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  wished_.notify_all();
  if (thread_.joinable()) thread_.join();
  if (checking_.valid()) checking_.wait();
  recording_.stop();
  const Result<void> lines = lines_ ? lines_->finish() : Result<void>();
  if (failed_) return *failed_;
  DUO_TRY(lines);
  if (const auto failure = recording_.failure()) return *failure;
  return cut_ ? Exit::kCut : Exit::kOk;
}

bool Player::resting() const {
  const std::lock_guard lock(mutex_);
  return status_.state == PlayState::kEnded;
}

void Player::run() {
  std::unique_lock lock(mutex_);
  while (!stopped_) {
    if (!wishes_.empty()) {
      const auto wishes = std::exchange(wishes_, {});
      lock.unlock();
      for (const auto& wish : wishes) wish();
      options_.on_news();
      lock.lock();
      continue;
    }
    const bool moves = status_.state == PlayState::kPlaying || (step_ && status_.state == PlayState::kPaused);
    const double wait_ms = step_ || live_ ? 0 : next_ms_ - now_ms();
    if (moves && wait_ms <= 0) {
      lock.unlock();
      advance();
      options_.on_news();
      lock.lock();
    } else {
      const auto woken = [this] { return stopped_ || !wishes_.empty(); };
      wished_.wait_for(lock, std::chrono::duration<double, std::milli>(moves ? wait_ms : 1000), woken);
    }
  }
}

/// The next frame: track it, show it, write it.
void Player::advance() {
  const Result<Next> next = run_->next();
  if (!next) return fail(next.error(), true);
  {
    const std::lock_guard lock(mutex_);
    status_.silent = *next == Next::kNothing;
    status_.dropped = run_->frames().dropped();
    if (live_) status_.event = run_->frames().warning();
    if (status_.event.empty() && now_ms() < passing_until_ms_) status_.event = passing_words_;
  }
  if (*next == Next::kNothing) return;  // a step is still to come
  step_ = false;
  if (*next != Next::kPicture) return at_end(*next);
  has_frame_ = true;
  const double now = now_ms();
  const double interval = last_ms_ > 0 ? now - last_ms_ : 0;
  last_ms_ = now;
  // Late frames shift all that follow: none is left out, and none is hurried.
  next_ms_ = std::max(next_ms_, now - 1000 * header_.frame_s) + 1000 * header_.frame_s;

  const auto number = static_cast<std::int64_t>(run_->frames().last().pair.sequence);
  const bool again = !live_ && selected_ && selected_->first == number;
  const auto selected = again ? run_->select(selected_->second) : Result<std::span<const Person>>(run_->track());
  keep(selected ? *selected : run_->track());
  if (!people_.empty()) write_line(run_->tracked(people_));
  std::string words = run_->frames().last().event;
  if (const auto warning = live_ ? skew_.see(run_->tracked(people_)) : std::nullopt) words += *warning;
  if (!words.empty()) {
    constexpr double kRead_ms = 10'000;
    passing_words_ = std::move(words);
    passing_until_ms_ = now + kRead_ms;
  }
  show(interval);
}

void Player::at_end(Next end) {
  recording_.stop();
  cut_ = cut_ || end == Next::kCut;
  warning_ = run_->frames().warning();
  {
    const std::lock_guard lock(mutex_);
    status_.problem = warning_;
    if (!status_.loop || live_ || !has_frame_) {
      status_.state = PlayState::kEnded;
      return;
    }
  }
  reopen();
}

/// From the first pair again. What was selected is selected again when its frame comes.
bool Player::reopen() {
  const std::int64_t frames = run_ && has_frame_ ? static_cast<std::int64_t>(run_->frames().last().pair.sequence) + 1 : 0;
  run_.reset();  // before another: a file may be a device
  recording_.stop();
  auto run = open_run(options_, recording_);
  if (!run) {
    fail(run.error(), true);
    return false;
  }
  run_.emplace(std::move(*run));
  passed_ += frames;
  passed_s_ += static_cast<double>(frames) * header_.frame_s;
  has_frame_ = false;
  people_.clear();
  return true;
}

void Player::write_line(TrackedFrame frame) {
  if (!lines_) return;
  frame.number += passed_;
  frame.t_s += passed_s_;
  if (const auto written = lines_->write(frame); !written) {
    lines_.reset();
    return fail(written.error(), false);
  }
  ++written_;
}

void Player::show(double interval_ms) {
  const TrackedFrame now = run_->tracked(people_);
  auto shown = std::make_shared<Shown>();
  shown->number = now.number;
  shown->t_s = now.t_s;
  shown->left = copy_of(now.left);
  shown->frame.color = now.frame.color.clone();
  shown->frame.disparity.d_q4 = now.frame.disparity.d_q4.clone();
  shown->people = people_;
  shown->times = run_->times();
  shown->interval_ms = interval_ms;
  shown->skew_ms = static_cast<double>(now.frame.skew_ns) * 1e-6;
  shown->latency_ms = live_ ? now_ms() - static_cast<double>(now.left.t_ns) * 1e-6
                            : shown->times.engine_ms + (people_.empty() ? 0 : shown->times.tracker_ms);
  const std::lock_guard lock(mutex_);
  newest_ = std::move(shown);
  status_.lines = written_;
}

/// Says it in the window; `for_good`: nothing more comes.
void Player::fail(const Error& error, bool for_good) {
  if (for_good) recording_.stop();
  if (for_good || error.code == ErrorCode::kWriteFailed) failed_ = failed_.value_or(error);
  const std::lock_guard lock(mutex_);
  status_.problem = error.what;
  if (for_good) status_.state = PlayState::kEnded;
}

}  // namespace duo::app::view
