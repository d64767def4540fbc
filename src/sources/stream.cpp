#include "sources/stream.h"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <thread>
#include <utility>

#include "core/clock.h"
#include "core/libav.h"

namespace duo {
namespace {

constexpr char kPipeline[] = "gst:";
constexpr auto kFirstPicture = std::chrono::seconds(10);
constexpr auto kStreamPatience = std::chrono::milliseconds(500);
constexpr auto kTryAgain = std::chrono::milliseconds(500);
constexpr auto kGoodbye = std::chrono::seconds(3);  // longer than every time-out below
constexpr int kOpenTimeout_ms = 2000, kReadTimeout_ms = 2000;

/// What the reading thread and its source share. It outlives the source while a call into OpenCV hangs: there is no way to end
/// one.
struct StreamState {
  std::string name;
  std::mutex mutex;
  std::condition_variable changed;
  cv::Mat newest;             // BGR
  TimeNs t_ns = 0;            // of its arrival
  std::uint64_t arrived = 0;  // pictures so far
  double rate_hz = 0;
  std::string trouble;
  bool stopped = false, ended = false;
};

/// What libraries print is said in our results.
void silence() {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  av_log_set_callback([](void*, int, const char*, va_list) {});  // a level would be set again by OpenCV
}

cv::VideoCapture open_capture(const std::string& name) {
  const bool pipeline = name.rfind(kPipeline, 0) == 0;
  cv::VideoCapture capture;
  if (pipeline)
    capture.open(name.substr(sizeof kPipeline - 1), cv::CAP_GSTREAMER);
  else
    capture.open(name, cv::CAP_FFMPEG,
                 {cv::CAP_PROP_OPEN_TIMEOUT_MSEC, kOpenTimeout_ms, cv::CAP_PROP_READ_TIMEOUT_MSEC, kReadTimeout_ms});
  return capture;
}

/// Until the stream breaks off or is no longer wanted.
void read_stream(StreamState& state) {
  cv::VideoCapture capture = open_capture(state.name);
  cv::Mat picture;
  while (capture.isOpened() && capture.read(picture) && picture.type() == CV_8UC3) {
    const std::lock_guard lock(state.mutex);
    if (state.stopped) return;
    cv::swap(state.newest, picture);
    state.t_ns = wall_ns();
    if (state.arrived++ == 0) state.rate_hz = capture.get(cv::CAP_PROP_FPS);
    state.trouble.clear();
    state.changed.notify_all();
  }
}

void run_stream(const std::shared_ptr<StreamState>& state) {
  silence();
  while (true) {
    try {
      read_stream(*state);
    } catch (const std::exception&) {  // of OpenCV: as if it had broken off
    }
    std::unique_lock lock(state->mutex);
    state->trouble = fmt::format("{} is away: it gives no pictures; opening it again", state->name);
    state->changed.notify_all();
    state->changed.wait_for(lock, kTryAgain, [&] { return state->stopped; });
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
      return Error{ErrorCode::kNotFound,
                   fmt::format("cannot open stream {}: it gives no picture; is its camera on, and the address right, or is the "
                               "pipeline's every element installed and the last one appsink?",
                               state_->name)};
    size_ = {state_->newest.cols, state_->newest.rows};
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
    if (Size{state_->newest.cols, state_->newest.rows} != size_)
      return Error{ErrorCode::kUnsupported, fmt::format("cannot read stream {}: its pictures change size", state_->name)};
    if (into.pixels.size() != size_) into.pixels = Image<Rgb8>(size_);
    cv::Mat rgb(size_.height, size_.width, CV_8UC3, into.pixels.row(0),
                static_cast<std::size_t>(into.pixels.stride()) * sizeof(Rgb8));
    cv::cvtColor(state_->newest, rgb, cv::COLOR_BGR2RGB);
    into.t_ns = state_->t_ns;
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
  for (const char* prefix : {"http://", "https://", "rtsp://", kPipeline})
    if (name.rfind(prefix, 0) == 0) return true;
  return false;
}

Result<std::unique_ptr<Source>> open_stream(const std::string& name) {
  auto stream = std::make_unique<Stream>(name);
  DUO_TRY(stream->start());
  return std::unique_ptr<Source>(std::move(stream));
}

}  // namespace duo
