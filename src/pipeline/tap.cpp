#include "pipeline/tap.h"

#include <chrono>
#include <utility>

namespace duo {

Result<void> Recording::start(const std::filesystem::path& path, const RecorderSetup& setup, double most_s) {
  const std::lock_guard lock(file_mutex_);
  if (file_) return {};
  {
    const std::lock_guard status_lock(mutex_);
    status_ = {.on = true, .name = path.string()};
  }
  auto file = Recorder::open(path, setup);
  if (!file) {
    fail(file.error());
    return file.error();
  }
  file_.emplace(std::move(*file));
  most_s_ = most_s;
  return {};
}

void Recording::stop() {
  const std::lock_guard lock(file_mutex_);
  if (file_) complete();
}

void Recording::take(const Pair& pair, std::int64_t dropped) {
  const std::lock_guard lock(file_mutex_);
  if (!file_) return;
  if (file_->pairs() == 0) {
    start_ns_ = pair.left.t_ns;
    dropped_before_ = dropped;
  }
  const double length_s = static_cast<double>(pair.left.t_ns - start_ns_) * 1e-9;
  if (most_s_ > 0 && length_s >= most_s_) return complete();
  if (const Result<void> written = file_->write(pair); !written) return fail(written.error());
  const std::lock_guard status_lock(mutex_);
  status_.pairs = file_->pairs();
  status_.bytes = file_->bytes();
  status_.dropped = dropped - dropped_before_;
  status_.length_s = length_s;
}

RecordingStatus Recording::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

std::optional<Error> Recording::first_failure() const {
  const std::lock_guard lock(mutex_);
  return first_failure_;
}

void Recording::complete() {
  const Result<void> finished = file_->finish();
  if (!finished) return fail(finished.error());
  const std::lock_guard lock(mutex_);
  status_.on = false;
  status_.bytes = file_->bytes();
  status_.codecs = file_->codecs();
  file_.reset();
}

/// The recorder has completed its file by then.
void Recording::fail(const Error& error) {
  file_.reset();
  const std::lock_guard lock(mutex_);
  status_.on = false;
  status_.problem = error.what;
  if (!first_failure_) first_failure_ = error;
}

Tap::Tap(std::unique_ptr<PairSource> source, std::shared_ptr<Recording> recording)
    : source_(std::move(source)), recording_(std::move(recording)) {}

Result<void> Tap::read_all_pairs() {
  if (!live() || reader_.started()) return {};
  reads_ = true;
  auto reader = Worker::start(
      "take the next pair", [this](const std::stop_token& stop) { return read_all(stop); },
      [this](const Result<void>& result) { pairs_.close(result); });
  reads_ = reader.has_value();
  if (!reader) return reader.error();
  reader_ = std::move(*reader);
  return {};
}

Result<Next> Tap::next(Pair& into) {
  if (!reads_) {
    const std::lock_guard lock(source_mutex_);
    if (!reads_) return read(into);
  }
  DUO_TRY_ASSIGN(const Taken taken, pairs_.take(into, std::chrono::milliseconds(500)));
  if (taken == Taken::kClosed) return end_.load();
  return taken == Taken::kValue ? Next::kNew : Next::kNothing;
}

Result<Next> Tap::read(Pair& into) {
  DUO_TRY_ASSIGN(const Next next, source_->next(into));
  if (next == Next::kNew) recording_->take(into, source_->dropped());
  return next;
}

Result<void> Tap::read_all(const std::stop_token& stop) {
  for (Pair pair; !stop.stop_requested();) {
    const std::lock_guard lock(source_mutex_);  // who asked before this thread began still waits for a pair
    DUO_TRY_ASSIGN(const Next next, read(pair));
    if (next == Next::kNothing) continue;
    if (next != Next::kNew) {
      end_ = next;
      break;
    }
    if (!pairs_.put(pair)) break;
  }
  return {};
}

}  // namespace duo
