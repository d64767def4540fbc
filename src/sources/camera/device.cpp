#include "sources/camera/device.h"

#include <fmt/format.h>
#include <linux/videodev2.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace duo {
namespace {

constexpr std::uint32_t kCapture = V4L2_BUF_TYPE_VIDEO_CAPTURE;
constexpr std::uint32_t kBuffers = 4;
constexpr TimeNs kSecond_ns = 1'000'000'000;

/// Fixed-length text of the kernel, which need not end with 0.
template <std::size_t N>
std::string text_of(const __u8 (&field)[N]) {
  const char* text = reinterpret_cast<const char*>(field);
  return {text, strnlen(text, N)};
}

Error cannot_open(const std::string& path, int error) {
  const std::string what = fmt::format("cannot open camera {}: ", path);
  if (error == ENOENT || error == ENODEV || error == ENXIO)
    return {ErrorCode::kNotFound, what + "no such camera; is it plugged in? `duoptic cameras` lists those that are"};
  if (error == EACCES || error == EPERM)
    return {ErrorCode::kBadInput,
            what + "no permission; add yourself to its group (sudo usermod -aG video $USER) and log in again"};
  if (error == EBUSY) return {ErrorCode::kBadInput, what + "another program uses it; close that one"};
  return {ErrorCode::kBadInput, what + std::strerror(error)};
}

}  // namespace

std::string fourcc_text(std::uint32_t fourcc) {
  std::string text;
  for (int i = 0; i < 4; ++i) {
    const char c = static_cast<char>(fourcc >> (8 * i));
    text += c >= ' ' && c <= '~' ? c : '?';
  }
  return text;
}

Result<CameraDevice> CameraDevice::open(const SystemCalls& system, const std::string& path) {
  const int fd = system.open(path);
  if (fd < 0) return cannot_open(path, errno);
  CameraDevice device(system, fd);
  v4l2_capability answer{};
  const auto no_camera = [&] {
    return Error{ErrorCode::kUnsupported,
                 fmt::format("cannot open camera {}: it gives no pictures; `duoptic cameras` lists those that do", path)};
  };
  if (device.call(VIDIOC_QUERYCAP, &answer) < 0) return errno == ENODEV ? cannot_open(path, ENODEV) : no_camera();
  const std::uint32_t can = (answer.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? answer.device_caps : answer.capabilities;
  // A webcam has a second device for what it says about its pictures.
  if ((can & V4L2_CAP_VIDEO_CAPTURE) == 0 || (can & V4L2_CAP_STREAMING) == 0) return no_camera();
  device.info_.path = path;
  device.info_.name = text_of(answer.card);
  device.info_.bus_path = text_of(answer.bus_info);
  const std::string usb = "/sys/class/video4linux/" + path.substr(path.rfind('/') + 1) + "/device/../";
  device.info_.serial = system.read(usb + "serial");
  device.info_.usb_mbit_s = std::atoi(system.read(usb + "speed").c_str());
  return device;
}

CameraDevice::CameraDevice(CameraDevice&& other) noexcept
    : system_(other.system_),
      fd_(std::exchange(other.fd_, -1)),
      info_(std::move(other.info_)),
      format_(other.format_),
      buffers_(std::exchange(other.buffers_, {})),
      running_(std::exchange(other.running_, false)) {}

CameraDevice::~CameraDevice() {
  if (fd_ < 0) return;
  release();
  system_->close(fd_);
}

/// Stops and forgets the buffers, so that another format can be asked for. A camera that is gone refuses all of it: no matter.
void CameraDevice::release() {
  if (buffers_.empty() && !running_) return;
  int type = kCapture;
  if (running_) call(VIDIOC_STREAMOFF, &type);
  running_ = false;
  for (const Mapped& buffer : buffers_) system_->unmap(buffer.start, buffer.bytes);
  buffers_.clear();
  v4l2_requestbuffers none{};
  none.type = kCapture;
  none.memory = V4L2_MEMORY_MMAP;
  call(VIDIOC_REQBUFS, &none);
}

int CameraDevice::call(unsigned long request, void* argument) const {
  constexpr int kTries = 10;  // a signal may come, but not for ever
  for (int i = 0; i < kTries; ++i) {
    const int result = system_->ioctl(fd_, request, argument);
    if (result >= 0 || errno != EINTR) return result;
  }
  return -1;
}

Error CameraDevice::failed(const std::string& what) const {
  const int error = errno;
  if (error == EBUSY)
    return {ErrorCode::kBadInput, fmt::format("cannot use camera {}: another program uses it; close that one", info_.path)};
  if (error == ENODEV)
    return {ErrorCode::kDeviceLost, fmt::format("cannot use camera {}: it was unplugged; plug it in again", info_.path)};
  return {ErrorCode::kUnsupported, fmt::format("cannot use camera {}: {}: {}", info_.path, what, std::strerror(error))};
}

Result<CameraDevice::Start> CameraDevice::start(std::uint32_t fourcc, const CameraWish& wish) {
  release();
  DUO_TRY(set_format(fourcc, wish));
  DUO_TRY(map_buffers());
  int type = kCapture;
  if (call(VIDIOC_STREAMON, &type) == 0) {
    running_ = true;
    return Start::kRunning;
  }
  if (errno == ENOSPC) return Start::kNoBandwidth;
  return failed("it does not start");
}

Result<void> CameraDevice::set_format(std::uint32_t fourcc, const CameraWish& wish) {
  v4l2_format format{};
  format.type = kCapture;
  format.fmt.pix.width = static_cast<std::uint32_t>(wish.size.width);
  format.fmt.pix.height = static_cast<std::uint32_t>(wish.size.height);
  format.fmt.pix.pixelformat = fourcc;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  if (call(VIDIOC_S_FMT, &format) < 0)
    return failed(fmt::format("it refuses {}x{} as {}", wish.size.width, wish.size.height, fourcc_text(fourcc)));
  const v4l2_pix_format& got = format.fmt.pix;
  format_.fourcc = got.pixelformat;
  format_.size = {static_cast<int>(got.width), static_cast<int>(got.height)};
  format_.stride_bytes = static_cast<int>(got.bytesperline);
  if (format_.size != wish.size)
    return Error{ErrorCode::kUnsupported,
                 fmt::format("cannot use camera {}: asked for {}x{} it gives {}x{}; `duoptic cameras` lists the sizes it has",
                             info_.path, wish.size.width, wish.size.height, got.width, got.height)};
  v4l2_streamparm rate{};
  rate.type = kCapture;
  rate.parm.capture.timeperframe = {1000, static_cast<std::uint32_t>(std::max(1.0, wish.rate_hz * 1000))};
  format_.rate_hz = wish.rate_hz;
  if (call(VIDIOC_S_PARM, &rate) == 0) {
    const v4l2_fract& frame = rate.parm.capture.timeperframe;
    if (frame.numerator > 0 && frame.denominator > 0)
      format_.rate_hz = std::clamp(static_cast<double>(frame.denominator) / frame.numerator, 1.0, 1000.0);
  }
  return {};
}

Result<void> CameraDevice::map_buffers() {
  v4l2_requestbuffers wanted{};
  wanted.type = kCapture;
  wanted.memory = V4L2_MEMORY_MMAP;
  wanted.count = kBuffers;
  if (call(VIDIOC_REQBUFS, &wanted) < 0) return failed("it gives no buffers");
  if (wanted.count < 2) {
    errno = ENOMEM;
    return failed("it gives fewer than two buffers");
  }
  for (std::uint32_t i = 0; i < wanted.count; ++i) {
    v4l2_buffer buffer{};
    buffer.type = kCapture;
    buffer.memory = V4L2_MEMORY_MMAP;
    buffer.index = i;
    if (call(VIDIOC_QUERYBUF, &buffer) < 0) return failed("its buffers cannot be asked for");
    void* start = system_->map(fd_, buffer.length, buffer.m.offset);
    if (start == nullptr) return failed("its buffers cannot be mapped");
    buffers_.push_back({start, buffer.length});
    if (call(VIDIOC_QBUF, &buffer) < 0) return failed("it does not take a buffer");
  }
  return {};
}

CameraDevice::Take CameraDevice::take(int timeout_ms, TakenBuffer& into) {
  // Kernels have called it an error to poll while all buffers are out, so only who waits does.
  const int events = timeout_ms > 0 ? system_->poll(fd_, timeout_ms) : POLLIN;
  if (events == 0) return Take::kNothing;
  if (events < 0) return errno == EINTR ? Take::kNothing : Take::kGone;
  if ((events & (POLLERR | POLLHUP | POLLNVAL)) != 0) return Take::kGone;
  v4l2_buffer buffer{};
  buffer.type = kCapture;
  buffer.memory = V4L2_MEMORY_MMAP;
  if (call(VIDIOC_DQBUF, &buffer) < 0) {
    // EIO is one buffer lost inside the camera.
    return errno == EAGAIN || errno == EINTR || errno == EIO ? Take::kNothing : Take::kGone;
  }
  if (buffer.index >= buffers_.size()) return Take::kGone;
  const Mapped& mapped = buffers_[buffer.index];
  into.index = buffer.index;
  into.bytes = {static_cast<const char*>(mapped.start), std::min<std::size_t>(buffer.bytesused, mapped.bytes)};
  into.damaged = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0;
  into.sequence = buffer.sequence;
  into.arrived_ns = system_->now_ns();
  TimeNs stamp_ns = TimeNs{buffer.timestamp.tv_sec} * kSecond_ns + TimeNs{buffer.timestamp.tv_usec} * 1000;
  // Stamped when its last byte was there: the sensor was read out during about one frame time before.
  if ((buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) != V4L2_BUF_FLAG_TSTAMP_SRC_SOE)
    stamp_ns -= static_cast<TimeNs>(1e9 / format_.rate_hz);
  const bool ours = (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  const bool likely = stamp_ns <= into.arrived_ns && stamp_ns > into.arrived_ns - kSecond_ns;
  into.exposure_ns.reset();
  if (ours && likely) into.exposure_ns = stamp_ns;
  return Take::kBuffer;
}

void CameraDevice::give_back(const TakenBuffer& taken) {
  v4l2_buffer buffer{};
  buffer.type = kCapture;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = taken.index;
  call(VIDIOC_QBUF, &buffer);  // one that is gone is seen by the next take()
}

std::optional<CameraDevice::Control> CameraDevice::control(std::uint32_t id) const {
  v4l2_queryctrl query{};
  query.id = id;
  if (call(VIDIOC_QUERYCTRL, &query) < 0 || (query.flags & V4L2_CTRL_FLAG_DISABLED) != 0) return std::nullopt;
  v4l2_control now{};
  now.id = id;
  if (call(VIDIOC_G_CTRL, &now) < 0) return std::nullopt;
  return Control{query.minimum, query.maximum, now.value};
}

bool CameraDevice::set_control(std::uint32_t id, int value) {
  v4l2_control set{};
  set.id = id;
  set.value = value;
  return call(VIDIOC_S_CTRL, &set) == 0;
}

}  // namespace duo
