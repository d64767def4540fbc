#include "recording.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <new>
#include <utility>

namespace duo::app {

std::string dated_recording_name() {
  const std::string stem = fmt::format("duoptic_{:%Y-%m-%d_%H-%M-%S}", fmt::localtime(std::time(nullptr)));
  std::error_code ignored;
  std::string name = stem + ".mkv";
  for (int i = 2; std::filesystem::exists(name, ignored); ++i) name = fmt::format("{}_{}.mkv", stem, i);
  return name;
}

Result<void> Recording::start(const std::string& name, const RecorderSetup& setup) {
  const std::lock_guard lock(file_mutex_);
  if (file_) return {};
  {
    const std::lock_guard status_lock(mutex_);
    status_ = {.on = true, .name = name};
  }
  auto file = Recorder::open(name, setup);
  if (!file) {
    fail(file.error());
    return file.error();
  }
  file_.emplace(std::move(*file));
  return {};
}

void Recording::stop() {
  const std::lock_guard lock(file_mutex_);
  if (!file_) return;
  const Result<void> finished = file_->finish();
  if (!finished) return fail(finished.error());
  const std::lock_guard status_lock(mutex_);
  status_.on = false;
  status_.bytes = file_->bytes();
  file_.reset();
}

void Recording::take(const Pair& pair) {
  const std::lock_guard lock(file_mutex_);
  if (!file_) return;
  if (file_->pairs() == 0) start_ns_ = pair.left.t_ns;
  if (const Result<void> written = file_->write(pair); !written) return fail(written.error());
  const std::lock_guard status_lock(mutex_);
  status_.pairs = file_->pairs();
  status_.bytes = file_->bytes();
  status_.length_s = static_cast<double>(pair.left.t_ns - start_ns_) * 1e-9;
}

RecordingStatus Recording::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

std::optional<Error> Recording::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

/// The recorder has completed its file by then.
void Recording::fail(const Error& error) {
  file_.reset();
  const std::lock_guard lock(mutex_);
  status_.on = false;
  status_.problem = error.what;
  failure_ = failure_.value_or(error);
}

Tap::Tap(std::unique_ptr<PairSource> source, Recording& recording) : source_(std::move(source)), recording_(recording) {
  if (source_->live()) reader_ = std::thread([this] { read_all(); });
}

Tap::~Tap() {
  stopped_ = true;
  if (reader_.joinable()) reader_.join();
}

Result<Next> Tap::next(Pair& into) {
  if (!live()) return read(into);
  constexpr auto kPatience = std::chrono::milliseconds(500);
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, kPatience, [this] { return arrived_.has_value(); });
  if (!arrived_) return Next::kNothing;
  std::swap(into, newest_);
  return *std::exchange(arrived_, std::nullopt);
}

/// Nothing may be thrown out of a thread.
Result<Next> Tap::read(Pair& into) {
  try {
    DUO_TRY_ASSIGN(const Next next, source_->next(into));
    if (next == Next::kPicture) recording_.take(into);
    return next;
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::kUnsupported, "cannot take the next pair: out of memory; smaller pictures need less"};
  }
}

void Tap::read_all() {
  Pair pair;
  for (bool more = true; more && !stopped_;) {
    Result<Next> next = read(pair);
    if (next && *next == Next::kNothing) continue;
    more = next && *next == Next::kPicture;
    {
      const std::lock_guard lock(mutex_);
      if (arrived_) ++dropped_;
      std::swap(newest_, pair);
      arrived_ = std::move(next);
    }
    changed_.notify_one();
  }
}

}  // namespace duo::app
