#include "pipeline/frame_stream.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/clock.h"
#include "pipeline/flat_picture.h"

namespace duo {
namespace {

constexpr char kMakeFrame[] = "make the next frame";
// Pairs outside the engine: being read or read ahead, being aligned, the one before that, two in the queue of frames, on its way
// out of the queue, and the caller's.
constexpr std::size_t kPairsOutside = 7;

std::size_t pairs_in_engine(const PairSource& source, int at_once) {
  return static_cast<std::size_t>(source.live() ? 1 : std::max(1, at_once));
}

}  // namespace

FrameStream::FrameStream(std::unique_ptr<PairSource> source, Engine* engine, int at_once, Choice choice, Passed passed,
                         FocusLine* focus)
    : source_(std::move(source)),
      engine_(engine),
      focus_(focus),
      choice_(choice),
      budget_(source_->live() ? choice.cores : 0),
      pool_(pairs_in_engine(*source_, at_once) + kPairsOutside, [] { return Pair(); }),
      read_(passed.pairs),
      start_ns_(passed.start_ns),
      before_(std::move(passed.last)),
      ring_(pairs_in_engine(*source_, at_once)),
      frames_(source_->live() ? 1 : 2, WhenFull::kWait) {
  if (before_ != nullptr) align_.remember(*before_);
}

FrameStream::~FrameStream() {
  matcher_.ask_to_stop();
  if (focus_ != nullptr) focus_->close();
  frames_.close();
  pairs_.close();
  matcher_ = {};
  reader_ = {};
  const std::lock_guard lock(engine_mutex_);
  empty_engine();  // it works on pairs of ours
}

void FrameStream::start() {
  if (!source_->live()) {
    Result<Worker> reader = Worker::start(
        "read the next pair", [this](const std::stop_token&) { return read_all(); },
        [this](const Result<void>& result) { pairs_.close(result); });
    if (reader) reader_ = std::move(*reader);
  }
  Result<Worker> matcher = Worker::start(
      kMakeFrame, [this](const std::stop_token& stop) { return match_all(stop); },
      [this](const Result<void>& result) { frames_.close(result); });
  if (matcher) matcher_ = std::move(*matcher);
}

/// With the second pair it is a stream, and all pairs of the pool get their memory: none is allocated later.
Result<Next> FrameStream::read_pair(std::shared_ptr<Pair>& into) {
  into = pool_.lend();
  DUO_TRY_ASSIGN(const Next next, source_->next(*into));
  if (next != Next::kNew || ++pairs_read_ != 2) return next;
  std::vector<std::shared_ptr<Pair>> others(pool_.size() - 1);
  for (std::shared_ptr<Pair>& pair : others) {
    pair = pool_.lend();
    for (const auto& [picture, like] : {std::pair(&pair->left, &into->left), std::pair(&pair->right, &into->right)})
      if (picture->pixels.size() != like->pixels.size()) picture->pixels = Image<Rgb8>(like->pixels.size());
  }
  return next;
}

/// One pair ahead of who takes them.
Result<void> FrameStream::read_all() {
  std::shared_ptr<Pair> pair;
  while (pairs_.wait_for_room()) {
    DUO_TRY_ASSIGN(const Next next, read_pair(pair));
    if (next != Next::kNew) {
      end_ = next;
      break;
    }
    pairs_.put(pair);
  }
  return {};
}

Result<Next> FrameStream::take_pair(std::shared_ptr<Pair>& into) {
  into.reset();
  if (!reader_.started()) return read_pair(into);
  DUO_TRY_ASSIGN(const Taken taken, pairs_.take(into));
  return taken == Taken::kValue ? Next::kNew : end_.load();
}

Result<Next> FrameStream::choose_pair(std::shared_ptr<Pair>& into) {
  while (true) {
    DUO_TRY_ASSIGN(const Next next, take_pair(into));
    if (next != Next::kNew) return next;
    if (read_ == 0) start_ns_ = into->left.t_ns;
    const std::int64_t from_first = read_++ - choice_.first;
    if (from_first >= 0 && from_first % choice_.every == 0) {
      if (budget_.allows(wall_ns(), cpu_ns())) return Next::kNew;
      ++left_out_;
    }
    if (from_first + 1 >= 0 && (from_first + 1) % choice_.every == 0) {
      align_.remember(*into);
      if (!source_->live()) before_ = into;
    }
    if (source_->live()) return Next::kNothing;  // it may be long: who waits may want to stop
  }
}

Result<void> FrameStream::match_all(const std::stop_token& stop) {
  Matched item;
  while (!stop.stop_requested() && frames_.wait_for_room()) {
    DUO_TRY_ASSIGN(const Next next, make_next(item));
    if (next == Next::kNothing) continue;
    if (next != Next::kNew) {
      end_ = next;
      break;
    }
    frames_.put(item);
  }
  return {};
}

Result<Next> FrameStream::make_next(Matched& item) {
  while (!end_of_pairs_ && in_engine_ < ring_.size()) {
    Result<Next> next = choose_pair(item.pair);
    if (next && *next == Next::kNothing) break;
    if (!next || *next != Next::kNew) {
      end_of_pairs_ = std::move(next);
      break;
    }
    item.started_ns = wall_ns();
    align(item);
    if (focus_ != nullptr) item.focus = focus_->next();
    const std::lock_guard lock(engine_mutex_);
    std::swap(in_flight(in_engine_++), item);
    submit(in_flight(in_engine_ - 1));
  }
  if (in_engine_ == 0) return end_of_pairs_.value_or(Next::kNothing);
  const std::lock_guard lock(engine_mutex_);
  collect(in_flight(0));
  std::swap(item, in_flight(0));
  oldest_ = (oldest_ + 1) % ring_.size();
  --in_engine_;
  return Next::kNew;
}

void FrameStream::align(Matched& item) {
  item.aligned = false;
  if (engine_ == nullptr) return;
  if (before_ != nullptr && align_.begins_with(*item.pair)) align_.begin(*before_);
  before_ = source_->live() || choice_.every > 1 ? nullptr : item.pair;
  Image<Rgb8>* moved = align_.right_of(*item.pair);
  if (moved == nullptr) return;
  item.aligned = true;
  if (item.other_right.size() != moved->size()) item.other_right = Image<Rgb8>(moved->size());
  std::swap(item.other_right, *moved);
}

void FrameStream::submit(Matched& item) {
  item.setup = setup_;
  if (engine_ == nullptr) return;
  if (item.aligned) std::swap(item.pair->right.pixels, item.other_right);
  if (focus_ != nullptr) engine_->focus(item.focus);
  engine_->submit(*item.pair);
}

void FrameStream::collect(Matched& item) {
  if (engine_ == nullptr) return;
  item.frame = engine_->collect();
  if (is_flat(item.pair->left.pixels.view()) || is_flat(item.pair->right.pixels.view()))
    item.frame = without_depth(std::move(item.frame));
  item.engine_ms = static_cast<double>(wall_ns() - item.started_ns) * 1e-6;
  item.event = engine_->take_event();
  if (item.aligned) std::swap(item.pair->right.pixels, item.other_right);
}

/// Takes back what the engine works on.
void FrameStream::empty_engine() {
  for (std::size_t i = 0; i < in_engine_; ++i) collect(in_flight(i));
}

void FrameStream::refill_engine() {
  for (std::size_t i = 0; i < in_engine_; ++i) submit(in_flight(i));
}

/// While the engine is empty. In time as it was: the cameras have moved on since.
void FrameStream::make_anew(Matched& item) {
  item.started_ns = wall_ns();
  const std::shared_ptr<Pair> shared = item.pair;  // stays as it came, for who has it
  if (item.aligned) {
    item.pair = pool_.lend();
    item.pair->sequence = shared->sequence;
    item.pair->left.pixels = shared->left.pixels.clone();
    item.pair->left.t_ns = shared->left.t_ns;
    item.pair->right.t_ns = shared->right.t_ns;
    item.pair->left.coding_noise_q4 = shared->left.coding_noise_q4;
    item.pair->right.coding_noise_q4 = shared->right.coding_noise_q4;
  }
  submit(item);
  collect(item);
  item.pair = shared;
}

Result<Next> FrameStream::take_frame() {
  if (!matcher_.started()) {
    Next next = Next::kNothing;
    DUO_TRY(without_exceptions(kMakeFrame, [&]() -> Result<void> {
      DUO_TRY_ASSIGN(next, make_next(taken_));
      return {};
    }));
    return next;
  }
  constexpr auto kPatience = std::chrono::milliseconds(500);
  const std::optional<std::chrono::nanoseconds> patience =
      source_->live() ? std::optional<std::chrono::nanoseconds>(kPatience) : std::nullopt;
  DUO_TRY_ASSIGN(const Taken taken, frames_.take(taken_, patience));
  if (taken == Taken::kValue) return Next::kNew;
  return taken == Taken::kNothing ? Next::kNothing : end_.load();
}

Result<Next> FrameStream::next(Matched& into) {
  DUO_TRY_ASSIGN(const Next next, take_frame());
  if (next != Next::kNew) return next;
  std::swap(into, taken_);
  taken_.frame.reset();  // back into their pools
  taken_.pair.reset();
  if (into.setup == setup_) return Next::kNew;  // without the lock, which is held while the engine finishes a frame
  const std::lock_guard lock(engine_mutex_);
  empty_engine();
  make_anew(into);
  refill_engine();
  return Next::kNew;
}

Result<void> FrameStream::prepare(const Setup& setup, Matched& last) {
  const std::lock_guard lock(engine_mutex_);
  empty_engine();
  Result<void> prepared = engine_->prepare(setup);
  if (prepared) {
    ++setup_;
    if (last.pair != nullptr) make_anew(last);
  }
  refill_engine();
  return prepared;
}

}  // namespace duo
