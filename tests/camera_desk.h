// A desk with two webcams that are not there, behind the table of system calls.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>

#include "duoptic/source.h"
#include "sources/camera/system_calls.h"
#include "tests/fake_v4l2.h"
#include "tests/write_media.h"

namespace duo::test {

inline constexpr TimeNs kMs = 1'000'000;
inline constexpr CameraWish kWish{.size = kSize, .rate_hz = 30};

/// Raw bytes whose brightness says the picture's number: 0 .. 127, over and over.
inline std::string numbered(std::int64_t n, Size size) {
  std::string bytes(std::size_t{2} * size.width * size.height, '\x80');
  for (std::size_t i = 0; i < bytes.size(); i += 2) bytes[i] = static_cast<char>(16 + n % 128);
  return bytes;
}
inline int number_in(const Picture& picture) {
  return static_cast<int>(std::lround((picture.pixels.at(20, 20).g) * 219.0 / 255)) % 128;
}

/// Two webcams of a kind on one bus, at /dev/video0 and /dev/video2, and a clock that is not the machine's.
class Desk {
 public:
  Desk() {
    for (FakeV4l2& camera : cameras) {
      camera.modes = {{V4L2_PIX_FMT_YUYV, 64, 48, 30},
                      {V4L2_PIX_FMT_MJPEG, 64, 48, 30},
                      {V4L2_PIX_FMT_YUYV, 640, 480, 30},
                      {V4L2_PIX_FMT_MJPEG, 640, 480, 30}};
      camera.bytes = [](std::int64_t n, std::uint32_t) { return numbered(n, kSize); };
      camera.controls = {{V4L2_CID_EXPOSURE_AUTO, control(0, 3, 3)},
                         {V4L2_CID_EXPOSURE_ABSOLUTE, control(3, 2047, 250)},
                         {V4L2_CID_GAIN, control(0, 100, 40)},
                         {V4L2_CID_AUTO_WHITE_BALANCE, control(0, 1, 1)},
                         {V4L2_CID_WHITE_BALANCE_TEMPERATURE, control(2800, 6500, 4600)}};
    }
    cameras[1].bus = "usb-0000:00:14.0-2";
    for (std::size_t i = 0; i < 2; ++i) cameras[i].plugged = [this, i] { return plugged[i].load(); };
    calls.open = [this](const std::string& path) {
      for (std::size_t i = 0; i < 2; ++i)
        if (path == paths[i] && cameras[i].open()) return static_cast<int>(i);
      errno = ENOENT;
      return -1;
    };
    calls.close = [this](int fd) { return cameras[static_cast<std::size_t>(fd)].close(), 0; };
    calls.ioctl = [this](int fd, unsigned long request, void* argument) {
      return cameras[static_cast<std::size_t>(fd)].ioctl(request, argument, now());
    };
    calls.map = [this](int fd, std::size_t, std::int64_t offset) { return cameras[static_cast<std::size_t>(fd)].map(offset); };
    calls.unmap = [this](void*, std::size_t) { return ++unmaps, 0; };
    calls.read = [](const std::string&) { return std::string(); };
    calls.now_ns = [this] { return now(); };
    calls.poll = [this](int fd, int timeout_ms) { return poll(fd, timeout_ms); };
  }
  ~Desk() {
    for (FakeV4l2& camera : cameras) EXPECT_EQ(camera.opens, camera.closes);
    EXPECT_EQ(cameras[0].maps + cameras[1].maps, unmaps);
  }

  /// Time stands still but in poll(); many of them at once only with `speed`, where it runs that much faster than the
  /// machine's.
  TimeNs now() const {
    if (speed == 0) return still_ns;
    return static_cast<TimeNs>(speed * std::chrono::duration<double, std::nano>(Clock::now() - start_).count());
  }

  std::array<FakeV4l2, 2> cameras;
  std::array<std::string, 2> paths = {"/dev/video0", "/dev/video2"};
  std::array<std::atomic<bool>, 2> plugged = {true, true};
  SystemCalls calls;
  double speed = 0;
  TimeNs still_ns = 0;
  std::atomic<int> unmaps = 0;

 private:
  using Clock = std::chrono::steady_clock;

  static v4l2_queryctrl control(int min, int max, int value) {
    v4l2_queryctrl out{};
    out.minimum = min;
    out.maximum = max;
    out.default_value = value;
    return out;
  }

  int poll(int fd, int timeout_ms) {
    const TimeNs until = now() + timeout_ms * kMs;
    while (true) {
      if (fd >= 0)
        if (const int events = cameras[static_cast<std::size_t>(fd)].events(now()); events != 0) return events;
      if (now() >= until) return 0;
      const TimeNs wake =
          fd >= 0 ? std::min(until, std::max(now() + 1, cameras[static_cast<std::size_t>(fd)].next_ns())) : until;
      if (speed == 0)
        still_ns = wake;
      else
        std::this_thread::sleep_for(std::chrono::duration<double, std::nano>(std::max(1000.0, double(wake - now()) / speed)));
    }
  }

  Clock::time_point start_ = Clock::now();
};

}  // namespace duo::test
