#include "sources/camera/camera.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <ctime>
#include <mutex>
#include <optional>
#include <utility>

#include "sources/camera/clock_model.h"
#include "sources/camera/decode.h"
#include "sources/camera/device.h"
#include "sources/camera/modes.h"

namespace duo {
namespace {

constexpr TimeNs kMs_ns = 1'000'000;
constexpr int kWait_ms = 200;                 // one next(), so that who waits for it to end does not wait long
constexpr TimeNs kSilent_ns = 1000 * kMs_ns;  // without a picture a camera is away; 30 frame times
constexpr TimeNs kFirst_ns = 4000 * kMs_ns;   // until the first: some take seconds to start
constexpr TimeNs kSettle_ns = 1000 * kMs_ns;  // automatics need a second from the first picture
constexpr int kMostOtherSizes = 30;           // pictures of another size than agreed, in a row

std::string time_of_day() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  return fmt::format("{:%H:%M:%S}", local);
}

/// One camera as long as the program wants it, plugged in or not.
class CameraSource final : public Source {
 public:
  CameraSource(const SystemCalls& system, std::string name, const CameraWish& wish, CameraDevice device,
               std::shared_ptr<SharedControls> controls, bool leads)
      : system_(system),
        name_(std::move(name)),
        wish_(wish),
        camera_(device.info()),
        format_(device.format()),
        controls_(std::move(controls)),
        leads_(leads) {
    run(std::move(device));
  }

  Size size() const override { return format_.size; }
  std::int64_t count() const override { return 0; }
  bool still() const override { return false; }
  double frame_s() const override { return 1 / format_.rate_hz; }
  bool live() const override { return true; }
  std::int64_t dropped() const override { return dropped_; }
  std::string warning() const override {
    const std::lock_guard lock(mutex_);
    return said_.empty() || note_.empty() ? said_ + note_ : said_ + "; " + note_;
  }
  Result<Next> next(Picture& into) override;

 private:
  void run(CameraDevice device);
  bool come_back();
  void leave(const std::string& why);
  void settle_look();
  bool silent() const { return system_.now_ns() - since_ns_ > (first_ns_ != 0 ? kSilent_ns : kFirst_ns); }
  bool newest(int timeout_ms, TakenBuffer& buffer);
  bool decode(const TakenBuffer& buffer, Picture& into);
  void count(const TakenBuffer& buffer);
  void say(std::string& what, const std::string& text) {
    const std::lock_guard lock(mutex_);
    what = text;
  }

  const SystemCalls& system_;
  const std::string name_;
  const CameraWish wish_;
  const CameraInfo camera_;
  const CameraFormat format_;
  const std::shared_ptr<SharedControls> controls_;
  const bool leads_;

  std::optional<CameraDevice> device_;  // none while it is away
  std::optional<ClockModel> clock_;
  CameraDecoder decoder_;
  TimeNs since_ns_ = 0;            // of the last picture, or of the start
  TimeNs first_ns_ = 0;            // of the first picture since the start; 0 before it
  std::optional<TimeNs> away_ns_;  // since when, until it gives a picture again
  bool locked_ = false;            // the controls, since the start
  std::int64_t number_ = -1;       // of the last buffer, counted as the driver counts, on from before an absence
  std::uint32_t sequence_ = 0;
  std::int64_t given_number_ = -1;
  int other_sizes_ = 0;
  std::atomic<std::int64_t> dropped_ = 0;
  mutable std::mutex mutex_;
  std::string said_, note_;  // where it is; what cannot be locked
};

void CameraSource::run(CameraDevice device) {
  device_.emplace(std::move(device));
  clock_.emplace(1 / format_.rate_hz);
  since_ns_ = system_.now_ns();
  first_ns_ = 0;
  locked_ = false;
  other_sizes_ = 0;
}

void CameraSource::leave(const std::string& why) {
  device_.reset();
  if (!away_ns_) away_ns_ = system_.now_ns();
  say(said_, fmt::format("{} is away since {}: it {}; looking for it on {}", name_, time_of_day(), why, camera_.bus_path));
}

/// Looks for the camera once; waits a while when it is not there.
bool CameraSource::come_back() {
  constexpr int kLookEvery_ms = 200;
  for (int i = 0; i < kMostDevices; ++i) {
    auto device = CameraDevice::open(system_, device_path(i));
    if (!device) continue;
    const CameraInfo& found = device->info();
    if (found.bus_path != camera_.bus_path || found.name != camera_.name || found.serial != camera_.serial) continue;
    const auto started = device->start(format_.fourcc, wish_);
    const bool same = device->format().fourcc == format_.fourcc && device->format().size == format_.size;
    if (!started || *started != CameraDevice::Start::kRunning || !same) continue;
    run(std::move(*device));
    return true;
  }
  system_.poll(-1, kLookEvery_ms);
  return false;
}

/// Once the leader's automatics have settled, all cameras get the same controls; one that was away gets them again.
void CameraSource::settle_look() {
  if (!controls_ || locked_ || first_ns_ == 0) return;
  if (leads_ && !controls_->get() && system_.now_ns() - first_ns_ >= kSettle_ns) controls_->give(read_controls(*device_));
  const auto controls = controls_->get();
  if (!controls) return;
  locked_ = true;
  const std::string missing = lock_controls(*device_, *controls);
  say(note_, missing.empty() ? ""
                             : fmt::format("{} ({}) cannot be locked to the left camera's exposure and colours: {}", name_,
                                           camera_.name, missing));
}

/// Waits for a buffer and passes over those that have a newer one behind them. False when there is none, or the camera left.
bool CameraSource::newest(int timeout_ms, TakenBuffer& buffer) {
  CameraDevice::Take take = device_->take(timeout_ms, buffer);
  if (take == CameraDevice::Take::kBuffer) {
    count(buffer);
    TakenBuffer newer;
    while (true) {
      const auto more = device_->take(0, newer);
      if (more == CameraDevice::Take::kGone) take = more;
      if (more != CameraDevice::Take::kBuffer) break;
      count(newer);
      device_->give_back(std::exchange(buffer, newer));
    }
  }
  if (take == CameraDevice::Take::kGone) leave("was unplugged");
  return take == CameraDevice::Take::kBuffer;
}

/// Sequence numbers of the driver, unwrapped; drivers that do not count get the number after the last.
void CameraSource::count(const TakenBuffer& buffer) {
  const auto step = static_cast<std::int32_t>(buffer.sequence - sequence_);
  number_ += first_ns_ != 0 && step > 1 ? step : 1;
  sequence_ = buffer.sequence;
}

bool CameraSource::decode(const TakenBuffer& buffer, Picture& into) {
  if (buffer.damaged) return false;
  const auto outcome = decoder_.decode(device_->format(), buffer.bytes, into);
  if (outcome != CameraDecoder::Outcome::kOtherSize)
    other_sizes_ = 0;
  else if (++other_sizes_ >= kMostOtherSizes)
    leave(fmt::format("sends pictures of another size than the {}x{} it agreed to", format_.size.width, format_.size.height));
  return outcome == CameraDecoder::Outcome::kWhole;
}

Result<Next> CameraSource::next(Picture& into) {
  if (!device_ && !come_back()) return Next::kNothing;
  settle_look();
  const TimeNs until_ns = system_.now_ns() + kWait_ms * kMs_ns;
  for (TimeNs now_ns = system_.now_ns(); now_ns < until_ns; now_ns = system_.now_ns()) {
    TakenBuffer buffer;
    if (!newest(static_cast<int>((until_ns - now_ns) / kMs_ns) + 1, buffer)) {
      if (device_ && silent()) leave("sends no pictures");
      if (!device_) return Next::kNothing;
      continue;
    }
    const TimeNs t_ns = clock_->capture_ns(number_, buffer.exposure_ns.value_or(buffer.arrived_ns));
    if (first_ns_ == 0) first_ns_ = buffer.arrived_ns;
    const bool whole = decode(buffer, into);
    if (device_) device_->give_back(buffer);
    if (device_ && !whole && silent()) leave("sends no whole pictures");
    if (!device_) return Next::kNothing;
    if (!whole) continue;
    since_ns_ = buffer.arrived_ns;
    if (away_ns_)
      say(said_, fmt::format("{} is back since {}, after {:.1f} s", name_, time_of_day(),
                             static_cast<double>(system_.now_ns() - *std::exchange(away_ns_, std::nullopt)) * 1e-9));
    into.t_ns = t_ns;
    dropped_ += number_ - given_number_ - 1;
    given_number_ = number_;
    into.sequence = static_cast<std::uint64_t>(number_);
    return Next::kNew;
  }
  return Next::kNothing;
}

Error no_bandwidth(const std::string& name, bool alone) {
  return {ErrorCode::kUnsupported,
          fmt::format("cannot start camera {}: the USB bus has no bandwidth left{}; plug the cameras into ports of different "
                      "controllers (front and back of a computer, not one hub), or ask for a smaller size",
                      name, alone ? "" : " for two streams, not even as MJPG")};
}

/// An opened camera with its modes.
Result<CameraDevice> open_device(const SystemCalls& system, const std::string& name, CameraInfo& info) {
  DUO_TRY_ASSIGN(const std::string path, camera_path(system, name));
  DUO_TRY_ASSIGN(CameraDevice device, CameraDevice::open(system, path));
  info = device.info();
  info.modes = device.modes();
  return device;
}

/// Starts it in the best format; false when the bus has no room.
Result<bool> start(CameraDevice& device, const CameraInfo& info, const CameraWish& wish, bool raw) {
  DUO_TRY_ASSIGN(const std::uint32_t fourcc, choose_format(info, wish, raw));
  DUO_TRY_ASSIGN(const CameraDevice::Start started, device.start(fourcc, wish));
  if (!CameraDecoder::is_known(device.format().fourcc))
    return Error{ErrorCode::kUnsupported, fmt::format("cannot use camera {}: asked for {} it gives {}, which is not read here",
                                                      info.path, fourcc_text(fourcc), fourcc_text(device.format().fourcc))};
  return started == CameraDevice::Start::kRunning;
}

}  // namespace

Result<std::unique_ptr<Source>> open_camera(const SystemCalls& system, const std::string& name, const CameraWish& wish) {
  CameraInfo info;
  DUO_TRY_ASSIGN(CameraDevice device, open_device(system, name, info));
  DUO_TRY_ASSIGN(bool started, start(device, info, wish, raw_fits(info, wish)));
  if (!started) {
    DUO_TRY_ASSIGN(started, start(device, info, wish, false));
  }
  if (!started) return no_bandwidth(name, true);
  return std::unique_ptr<Source>(std::make_unique<CameraSource>(system, name, wish, std::move(device), nullptr, false));
}

Result<std::array<std::unique_ptr<Source>, 2>> open_cameras(const SystemCalls& system, const std::string& left,
                                                            const std::string& right, const CameraWish& wish) {
  std::array<CameraInfo, 2> infos;
  DUO_TRY_ASSIGN(CameraDevice first, open_device(system, left, infos[0]));
  DUO_TRY_ASSIGN(CameraDevice second, open_device(system, right, infos[1]));
  if (infos[0].path == infos[1].path)
    return Error{ErrorCode::kBadInput, fmt::format("cannot pair {} with {}: both are {}", left, right, infos[0].path)};
  const bool raw = raw_fits(infos[0], infos[1], wish);
  for (const bool try_raw : {raw, false}) {
    DUO_TRY_ASSIGN(const bool left_runs, start(first, infos[0], wish, try_raw));
    DUO_TRY_ASSIGN(const bool right_runs, left_runs ? start(second, infos[1], wish, try_raw) : Result<bool>(false));
    if (left_runs && right_runs) break;
    if (!try_raw) return no_bandwidth(left_runs ? right : left, false);
  }
  const auto controls = std::make_shared<SharedControls>();
  return std::array<std::unique_ptr<Source>, 2>{
      std::make_unique<CameraSource>(system, left, wish, std::move(first), controls, true),
      std::make_unique<CameraSource>(system, right, wish, std::move(second), controls, false)};
}

}  // namespace duo
