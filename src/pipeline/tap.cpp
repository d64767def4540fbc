#include "pipeline/tap.h"

#include <atomic>
#include <chrono>
#include <utility>

#include "duoptic/bounded_queue.h"
#include "duoptic/worker.h"

namespace duo {
namespace {

class Tap : public PairSource {
 public:
  Tap(std::unique_ptr<PairSource> source, std::shared_ptr<Recording> recording)
      : source_(std::move(source)), recording_(std::move(recording)) {}

  Size size() const override { return source_->size(); }
  std::int64_t count() const override { return source_->count(); }
  bool still() const override { return source_->still(); }
  double frame_s() const override { return source_->frame_s(); }
  std::optional<Rig> rig() const override { return source_->rig(); }
  bool live() const override { return source_->live(); }
  std::int64_t dropped() const override { return source_->dropped(); }
  std::string warning() const override { return source_->warning(); }
  Result<Next> next(Pair& into) override {
    DUO_TRY_ASSIGN(const Next next, source_->next(into));
    if (next == Next::kPicture) recording_->take(into, source_->dropped());
    return next;
  }

 private:
  std::unique_ptr<PairSource> source_;
  std::shared_ptr<Recording> recording_;
};

class LiveTap final : public Tap {
 public:
  using Tap::Tap;
  Result<void> start() {
    DUO_TRY_ASSIGN(reader_, Worker::start(
                                "take the next pair", [this](const std::stop_token& stop) { return read_all(stop); },
                                [this](const Result<void>& result) { pairs_.close(result); }));
    return {};
  }
  std::int64_t dropped() const override { return Tap::dropped() + pairs_.dropped(); }
  Result<Next> next(Pair& into) override {
    DUO_TRY_ASSIGN(const Taken taken, pairs_.take(into, std::chrono::milliseconds(500)));
    if (taken == Taken::kClosed) return end_.load();
    return taken == Taken::kValue ? Next::kPicture : Next::kNothing;
  }

 private:
  Result<void> read_all(const std::stop_token& stop) {
    for (Pair pair; !stop.stop_requested();) {
      DUO_TRY_ASSIGN(const Next next, Tap::next(pair));
      if (next == Next::kNothing) continue;
      if (next != Next::kPicture) {
        end_ = next;
        break;
      }
      if (!pairs_.put(pair)) break;
    }
    return {};
  }

  BoundedQueue<Pair> pairs_{1, WhenFull::kDropOldest};
  std::atomic<Next> end_ = Next::kEnd;
  Worker reader_;  // last: it uses all of the above
};

}  // namespace

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

Result<std::unique_ptr<PairSource>> tapped(std::unique_ptr<PairSource> pairs, std::shared_ptr<Recording> recording) {
  if (!pairs->live()) return std::unique_ptr<PairSource>(std::make_unique<Tap>(std::move(pairs), std::move(recording)));
  auto tap = std::make_unique<LiveTap>(std::move(pairs), std::move(recording));
  DUO_TRY(tap->start());
  return std::unique_ptr<PairSource>(std::move(tap));
}

}  // namespace duo
