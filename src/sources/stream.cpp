#include "sources/stream.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "core/clock.h"
#include "sources/stream_input.h"

namespace duo {
namespace {

constexpr auto kFirstPicture = std::chrono::seconds(10);
constexpr auto kStreamPatience = std::chrono::milliseconds(500);
constexpr auto kTryAgain = std::chrono::milliseconds(500);
constexpr auto kGoodbye = std::chrono::seconds(3);

/// What the reading thread and its source share. It outlives the source while a name is looked up in the network: there is no
/// way to end that.
struct StreamState {
  std::string name;
  std::mutex mutex;
  std::condition_variable changed;
  Picture newest;             // stamped with its arrival
  std::uint64_t arrived = 0;  // pictures so far
  double rate_hz = 0;
  std::string trouble, why;  // why: it could not be opened
  std::atomic<bool> stopped = false;
  bool ended = false;
};

/// Until the stream breaks off or is no longer wanted.
///
/// Returns  "" or why it could not be opened
std::string read_stream(StreamState& state) {
  StreamInput input([&] { return state.stopped.load(); });
  if (std::string why = input.open(state.name); !why.empty()) return why;
  Picture picture;
  while (input.next(picture)) {
    const std::lock_guard lock(state.mutex);
    if (state.stopped) break;
    std::swap(state.newest, picture);
    state.newest.t_ns = wall_ns();
    if (state.arrived++ == 0) state.rate_hz = input.rate_hz();
    state.trouble.clear();
    state.changed.notify_all();
  }
  return {};
}

void run_stream(const std::shared_ptr<StreamState>& state) {
  av_log_set_level(AV_LOG_QUIET);  // what is wrong is said in our results
  while (true) {
    const std::string why = read_stream(*state);
    std::unique_lock lock(state->mutex);
    state->why = why;
    state->trouble = fmt::format("{} is away: {}; opening it again", state->name, why.empty() ? "it gives no pictures" : why);
    state->changed.notify_all();
    state->changed.wait_for(lock, kTryAgain, [&] { return state->stopped.load(); });
    if (state->stopped) break;
  }
  const std::lock_guard lock(state->mutex);
  state->ended = true;
  state->changed.notify_all();
}

class Stream final : public Source {
 public:
  explicit Stream(const std::string& name) : state_(std::make_shared<StreamState>()) {
    state_->name = name;
    thread_ = std::thread([state = state_] { run_stream(state); });
  }
  ~Stream() override {
    std::unique_lock lock(state_->mutex);
    state_->stopped = true;
    state_->changed.notify_all();
    const bool ended = state_->changed.wait_for(lock, kGoodbye, [this] { return state_->ended; });
    lock.unlock();
    if (ended)
      thread_.join();
    else
      thread_.detach();
  }

  /// Waits for the first picture, which tells the size.
  Result<void> start() {
    std::unique_lock lock(state_->mutex);
    state_->changed.wait_for(lock, kFirstPicture, [this] { return state_->arrived > 0 || !state_->trouble.empty(); });
    if (state_->arrived == 0)
      return Error{
          ErrorCode::kNotFound,
          fmt::format("cannot open stream {}: {}; {}", state_->name, state_->why.empty() ? "it gives no picture" : state_->why,
                      state_->name.starts_with(kGstPrefix)
                          ? "does the pipeline run with gst-launch-1.0 and '! videoconvert ! autovideosink' after it?"
                          : "is its camera on, and the address right?")};
    size_ = state_->newest.pixels.size();
    if (state_->rate_hz >= 1 && state_->rate_hz <= 1000) frame_s_ = 1 / state_->rate_hz;
    return {};
  }

  Size size() const override { return size_; }
  std::int64_t count() const override { return 0; }
  bool still() const override { return false; }
  double frame_s() const override { return frame_s_; }
  bool live() const override { return true; }
  std::int64_t dropped() const override { return dropped_; }
  std::string warning() const override {
    const std::lock_guard lock(state_->mutex);
    return state_->trouble;
  }

  Result<Next> next(Picture& into) override {
    std::unique_lock lock(state_->mutex);
    if (!state_->changed.wait_for(lock, kStreamPatience, [this] { return state_->arrived > given_; })) return Next::kNothing;
    if (state_->newest.pixels.size() != size_)
      return Error{ErrorCode::kUnsupported, fmt::format("cannot read stream {}: its pictures change size", state_->name)};
    std::swap(into, state_->newest);  // what was given last holds the next one's memory
    into.sequence = state_->arrived - 1;
    dropped_ += static_cast<std::int64_t>(state_->arrived - given_ - 1);
    given_ = state_->arrived;
    return Next::kPicture;
  }

 private:
  std::shared_ptr<StreamState> state_;
  std::thread thread_;
  Size size_;
  double frame_s_ = 1.0 / 30;
  std::uint64_t given_ = 0;
  std::atomic<std::int64_t> dropped_ = 0;
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
