#include "sources/stream.h"

#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "core/clock.h"
#include "duoptic/bounded_queue.h"
#include "duoptic/worker.h"
#include "sources/arrival_clock.h"
#include "sources/stream_input.h"

namespace duo {
namespace {

constexpr auto kFirstPicture = std::chrono::seconds(10);
constexpr auto kMeasuring = std::chrono::seconds(1);  // from the first picture on, of the rate
constexpr auto kStreamPatience = std::chrono::milliseconds(500);
constexpr auto kTryAgain = std::chrono::milliseconds(500);
constexpr auto kGoodbye = std::chrono::seconds(3);

/// What the reading thread and its source share. It outlives the source while a name is looked up in the network: there is no
/// way to end that.
struct StreamState {
  std::string name;
  BoundedQueue<Picture> pictures{1, WhenFull::kDropOldest};
  std::mutex mutex;  // of what follows
  std::condition_variable measured;
  double frame_s = 0;  // 0: not measured yet
  std::string trouble;
};

double known_frame_s(StreamState& state) {
  const std::lock_guard lock(state.mutex);
  return state.frame_s;
}

/// Until the stream breaks off or is no longer wanted.
///
/// Returns  "" or why it could not be opened
std::string read_stream(StreamState& state, std::uint64_t& arrived, const std::stop_token& stop) {
  StreamInput input([&] { return stop.stop_requested(); });
  if (std::string why = input.open(state.name); !why.empty()) return why;
  ArrivalClock clock(input.frame_s() > 0 ? input.frame_s() : known_frame_s(state));
  Picture picture;
  while (input.next(picture)) {
    picture.t_ns = clock.capture_ns(wall_ns());
    picture.sequence = arrived++;
    {
      const std::lock_guard lock(state.mutex);
      state.trouble.clear();
      state.frame_s = clock.frame_s();
    }
    state.measured.notify_all();
    if (!state.pictures.put(picture)) break;
  }
  return {};
}

Error no_picture(const std::string& name, const std::string& why) {
  return {ErrorCode::kNotFound,
          fmt::format("cannot open stream {}: {}; {}", name, why.empty() ? "it gives no picture" : why,
                      name.starts_with(kGstPrefix)
                          ? "does the pipeline run with gst-launch-1.0 and '! videoconvert ! autovideosink' after it?"
                          : "is its camera on, and the address right?")};
}

/// Opens a stream that gave pictures again and again.
///
/// Errors  it gives none from the start
Result<void> run_stream(StreamState& state, const std::stop_token& stop) {
  av_log_set_level(AV_LOG_QUIET);  // what is wrong is said in our results
  std::condition_variable_any rest;
  for (std::uint64_t arrived = 0; !stop.stop_requested();) {
    const std::string why = read_stream(state, arrived, stop);
    if (arrived == 0) return no_picture(state.name, why);
    std::unique_lock lock(state.mutex);
    state.trouble = fmt::format("{} is away: {}; opening it again", state.name, why.empty() ? "it gives no pictures" : why);
    rest.wait_for(lock, stop, kTryAgain, [] { return false; });
  }
  return {};
}

class Stream final : public Source {
 public:
  explicit Stream(const std::string& name) : state_(std::make_shared<StreamState>()) { state_->name = name; }
  ~Stream() override {
    reader_.ask_to_stop();
    state_->pictures.close();
    if (reader_.started() && !reader_.ends_within(kGoodbye)) reader_.detach();
  }

  /// Waits for the first picture, which tells the size.
  Result<void> start() {
    DUO_TRY_ASSIGN(reader_, Worker::start(
                                "read stream " + state_->name,
                                [state = state_](const std::stop_token& stop) { return run_stream(*state, stop); },
                                [state = state_](const Result<void>& result) { state->pictures.close(result); }));
    DUO_TRY_ASSIGN(const Taken taken, state_->pictures.take(first_, kFirstPicture));
    if (taken != Taken::kValue) return no_picture(state_->name, {});
    size_ = first_.pixels.size();
    has_first_ = true;
    measured_until_ = std::chrono::steady_clock::now() + kMeasuring;
    return {};
  }

  Size size() const override { return size_; }
  std::int64_t count() const override { return 0; }
  bool still() const override { return false; }
  /// Waits for the pictures that tell it: two streams measure at the same time.
  double frame_s() const override {
    constexpr double kUnknown_s = 1.0 / 30;
    std::unique_lock lock(state_->mutex);
    const bool known = state_->measured.wait_until(lock, measured_until_, [this] { return state_->frame_s > 0; });
    return known ? state_->frame_s : kUnknown_s;
  }
  bool live() const override { return true; }
  std::int64_t dropped() const override { return state_->pictures.dropped(); }
  std::string warning() const override {
    const std::lock_guard lock(state_->mutex);
    return state_->trouble;
  }

  Result<Next> next(Picture& into) override {
    if (std::exchange(has_first_, false)) {
      std::swap(into, first_);
      return Next::kNew;
    }
    DUO_TRY_ASSIGN(const Taken taken, state_->pictures.take(into, kStreamPatience));
    if (taken != Taken::kValue) return Next::kNothing;
    if (into.pixels.size() != size_)
      return Error{ErrorCode::kUnsupported, fmt::format("cannot read stream {}: its pictures change size", state_->name)};
    return Next::kNew;
  }

 private:
  std::shared_ptr<StreamState> state_;
  Size size_;
  std::chrono::steady_clock::time_point measured_until_;
  Picture first_;  // has told the size, and was not given yet
  bool has_first_ = false;
  Worker reader_;
};

}  // namespace

bool is_stream_name(const std::string& name) {
  for (const char* prefix : {"http://", "https://", "rtsp://", kGstPrefix})
    if (name.starts_with(prefix)) return true;
  return false;
}

Result<std::unique_ptr<Source>> open_stream(const std::string& name) {
  auto stream = std::make_unique<Stream>(name);
  DUO_TRY(stream->start());
  return std::unique_ptr<Source>(std::move(stream));
}

}  // namespace duo
