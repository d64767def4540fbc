// One V4L2 camera that is open: its format, its buffers, its stream.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "duoptic/cameras.h"
#include "sources/camera/system_calls.h"

namespace duo {

/// How pictures come; what the driver made of what it was asked for.
struct CameraFormat {
  std::uint32_t fourcc = 0;
  Size size;
  int stride_bytes = 0;  // of raw formats
  double rate_hz = 30;
};

/// The kernel's code of a format with these letters, and back.
constexpr std::uint32_t fourcc_of(const char (&letters)[5]) {
  std::uint32_t code = 0;
  for (int i = 3; i >= 0; --i) code = code << 8 | static_cast<std::uint8_t>(letters[i]);
  return code;
}
std::string fourcc_text(std::uint32_t fourcc);

/// A buffer that the driver filled; its bytes are the device's until give_back().
struct TakenBuffer {
  std::string_view bytes;
  bool damaged = false;               // the driver knows that something is missing
  std::uint32_t sequence = 0;         // as the driver counts
  std::optional<TimeNs> exposure_ns;  // start of exposure on our clock; none when the driver's stamp is no use
  TimeNs arrived_ns = 0;
  std::uint32_t index = 0;
};

/// Stopped, unmapped and closed with this object. No call waits longer than it is told.
class CameraDevice {
 public:
  /// `path` names it in messages.
  ///
  /// Errors  no such device, no permission, no camera
  static Result<CameraDevice> open(const SystemCalls& system, const std::string& path);
  CameraDevice(CameraDevice&& other) noexcept;
  CameraDevice& operator=(CameraDevice&&) = delete;
  ~CameraDevice();

  const CameraInfo& info() const { return info_; }  // without modes
  /// Asks the driver for everything it can give.
  std::vector<CameraMode> modes() const;

  enum class Start : std::uint8_t { kRunning, kNoBandwidth };
  /// Errors  in use by another program, refused, another size than wished, too few buffers
  Result<Start> start(std::uint32_t fourcc, const CameraWish& wish);
  const CameraFormat& format() const { return format_; }

  enum class Take : std::uint8_t { kBuffer, kNothing, kGone };
  /// The next filled buffer, waiting `timeout_ms` for it at most; 0 only looks.
  Take take(int timeout_ms, TakenBuffer& into);
  void give_back(const TakenBuffer& buffer);

  /// A control's range and value; none when the camera lacks it.
  struct Control {
    int min = 0, max = 0, value = 0;
  };
  std::optional<Control> control(std::uint32_t id) const;
  bool set_control(std::uint32_t id, int value);

 private:
  CameraDevice(const SystemCalls& system, int fd) : system_(&system), fd_(fd) {}
  Result<void> set_format(std::uint32_t fourcc, const CameraWish& wish);
  Result<void> map_buffers();
  int call(unsigned long request, void* argument) const;
  Error failed(const std::string& what) const;
  void release();

  struct Mapped {
    void* start;
    std::size_t bytes;
  };
  const SystemCalls* system_;
  int fd_;
  CameraInfo info_;
  CameraFormat format_;
  std::vector<Mapped> buffers_;
  bool running_ = false;
};

}  // namespace duo
