#include "duoptic/calibration_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <utility>

namespace duo {
namespace {

constexpr TimeNs kEvery_ns = 100'000'000;  // of files
constexpr double kReported_m = 0.5;        // that the report counts disparities for

}  // namespace

CalibrationSession::CalibrationSession(CalibrationSessionSetup setup, std::unique_ptr<PairSource> pairs, const Board& board)
    : setup_(std::move(setup)), live_(pairs->live()), pairs_(std::move(pairs)), guide_(board, pairs_->size()) {
  status_.count = pairs_->count();
}

Result<std::unique_ptr<CalibrationSession>> CalibrationSession::start(CalibrationSessionSetup setup,
                                                                      std::unique_ptr<PairSource> pairs, const Board& board) {
  if (!setup.on_news) setup.on_news = [] {};
  if (!setup.open)
    setup.open = [name = setup.left_name] {
      return Error{ErrorCode::kUnsupported, fmt::format("cannot look for another board: {} cannot be read again", name)};
    };
  std::unique_ptr<CalibrationSession> out(new CalibrationSession(std::move(setup), std::move(pairs), board));
  DUO_TRY_ASSIGN(out->thread_,
                 Worker::start("look for the board", [c = out.get()](const std::stop_token& stop) { return c->run(stop); }));
  return out;
}

CalibrationSession::~CalibrationSession() {
  thread_.ask_to_stop();
  wishes_.close();
}

SessionStatus CalibrationSession::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

Board CalibrationSession::board() const {
  const std::lock_guard lock(mutex_);
  return guide_.board();
}

void CalibrationSession::choose(const Board& board) {
  post([this, board] { begin(board); });
}

void CalibrationSession::set_square_m(double square_m) {
  post([this, square_m] {
    {
      const std::lock_guard lock(mutex_);
      guide_.set_square_m(square_m);
      if (status_.state != SessionState::kSolved) return;
    }
    find_rig();
  });
}

void CalibrationSession::recognise() {
  post([this] {
    const auto pair = status().pair;
    if (!pair) return;
    const auto other = other_board(*pair, board());
    if (!other) return say("no other board was recognised in both pictures: show it whole, and to both cameras");
    begin(*other);
  });
}

void CalibrationSession::solve() {
  post([this] { find_rig(); });
}

void CalibrationSession::go_on() {
  post([this] {
    const std::lock_guard lock(mutex_);
    status_.state = ended_ ? SessionState::kEnded : SessionState::kLooking;
    if (!ended_) status_.found.reset();  // save() reads the guide, which looking changes
  });
}

Result<void> CalibrationSession::save(const std::string& file) const {
  const std::filesystem::path path = file;
  std::error_code ignored;
  if (file.empty()) return Error{ErrorCode::kWriteFailed, "cannot save the rig: give its file a name"};
  if (std::filesystem::exists(path, ignored))
    return Error{ErrorCode::kWriteFailed, fmt::format("cannot save the rig: {} is there already; choose another name", file)};
  const std::lock_guard lock(mutex_);
  if (!status_.found) return Error{ErrorCode::kWriteFailed, "cannot save the rig: there is none yet"};
  const Calibration& found = *status_.found;
  DUO_TRY_ASSIGN(const RigDescription can, describe_rig(found.rig, kReported_m));
  DUO_TRY(write_calibration_report(found, guide_.board(), can, guide_.shown(),
                                   path.parent_path() / (path.stem().string() + "_report.html")));
  return save_rig(found.rig, path);
}

bool CalibrationSession::looking() const {
  const std::lock_guard lock(mutex_);
  return status_.state == SessionState::kLooking;
}

void CalibrationSession::say(const std::string& problem) {
  const std::lock_guard lock(mutex_);
  status_.problem = problem;
}

Result<void> CalibrationSession::run(const std::stop_token& stop) {
  for (std::function<void()> wish; !stop.stop_requested();) {
    DUO_TRY_ASSIGN(const Taken taken, wishes_.take(wish, std::chrono::milliseconds(looking() ? 0 : 1000)));
    if (taken == Taken::kClosed) break;
    if (taken == Taken::kValue)
      wish();
    else if (looking())
      advance();
    else
      continue;
    setup_.on_news();
  }
  return {};
}

/// The next pair; of a file the next that is to be looked at.
void CalibrationSession::advance() {
  if (!pair_ || pair_.use_count() > 1) pair_ = std::make_shared<Pair>();
  const Result<Next> next = pairs_->next(*pair_);
  {
    const std::lock_guard lock(mutex_);
    status_.problem = !next ? next.error().what : live_ ? pairs_->warning() : "";
    status_.silent = next && *next == Next::kNothing;
    if (!next) status_.state = SessionState::kEnded;
    if (next && *next == Next::kNew) ++status_.looked;
  }
  if (!next || *next == Next::kNothing) return;
  if (*next != Next::kNew) {
    ended_ = true;
    if (guide_.views() >= CalibrationGuide::kFewestViews) return find_rig();
    const std::lock_guard lock(mutex_);
    status_.state = SessionState::kEnded;
    status_.problem =
        fmt::format("the end, with {} of {} views at least: show the board at more places, still for a second each",
                    guide_.views(), CalibrationGuide::kFewestViews);
    return;
  }
  if (!live_ && looked_ns_ != 0 && pair_->left.t_ns - looked_ns_ < kEvery_ns - kEvery_ns / 10) return;
  looked_ns_ = std::max<TimeNs>(pair_->left.t_ns, 1);
  look();
}

void CalibrationSession::look() {
  const GuideLook look = guide_.see(*pair_);
  const std::array<PictureFigures, 2> figures = {picture_figures(pair_->left.pixels), picture_figures(pair_->right.pixels)};
  {
    const std::lock_guard lock(mutex_);
    status_.pair = pair_;
    status_.look = look;
    status_.met = guide_.met();
    status_.views = guide_.views();
    status_.covered = {guide_.covered(0), guide_.covered(1)};
    status_.figures = figures;
    for (std::size_t i = 0; i < figures.size(); ++i) status_.best_focus[i] = std::max(status_.best_focus[i], figures[i].focus);
  }
  if (look.step == GuideStep::kTaken && guide_.enough()) find_rig();
}

/// Without views. A file is read from its start.
void CalibrationSession::begin(const Board& board) {
  if (!live_) {
    pairs_.reset();
    auto again = setup_.open();
    if (!again) {
      ended_ = true;  // there is nothing to look at
      say(again.error().what);
      const std::lock_guard lock(mutex_);
      status_.state = SessionState::kEnded;
      return;
    }
    pairs_ = std::move(*again);
  }
  ended_ = false;
  looked_ns_ = 0;
  const std::lock_guard lock(mutex_);
  guide_ = CalibrationGuide(board, pairs_->size());
  SessionStatus fresh;
  fresh.count = pairs_->count();
  fresh.pair = status_.pair;
  status_ = std::move(fresh);
}

void CalibrationSession::find_rig() {
  {
    const std::lock_guard lock(mutex_);
    status_.state = SessionState::kSolving;
    status_.found.reset();
    status_.problem.clear();
  }
  setup_.on_news();
  auto found = guide_.solve();
  const std::lock_guard lock(mutex_);
  status_.state = found ? SessionState::kSolved : ended_ ? SessionState::kEnded : SessionState::kLooking;
  if (!found) {
    status_.problem = found.error().what;
    return;
  }
  found->rig.left_name = setup_.left_name;
  found->rig.right_name = setup_.right_name;
  found->rig.date = date_now();
  status_.found = std::make_shared<const Calibration>(std::move(*found));
}

}  // namespace duo
