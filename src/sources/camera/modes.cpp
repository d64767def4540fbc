#include "sources/camera/modes.h"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <filesystem>

#include "sources/camera/decode.h"
#include "sources/camera/device.h"

namespace duo {
namespace {

constexpr std::uint32_t kMost = 64;  // answers to one question; a driver that never ends is stopped there
constexpr char kPrefix[] = "camera:";

double hz(const v4l2_fract& frame) { return frame.numerator > 0 ? double{1} * frame.denominator / frame.numerator : 0; }

std::vector<double> rates_hz(const SystemCalls& system, int fd, std::uint32_t fourcc, Size size) {
  std::vector<double> rates;
  for (std::uint32_t i = 0; i < kMost; ++i) {
    v4l2_frmivalenum rate{};
    rate.index = i;
    rate.pixel_format = fourcc;
    rate.width = static_cast<std::uint32_t>(size.width);
    rate.height = static_cast<std::uint32_t>(size.height);
    if (system.ioctl(fd, VIDIOC_ENUM_FRAMEINTERVALS, &rate) < 0) break;
    if (rate.type == V4L2_FRMIVAL_TYPE_DISCRETE) {
      rates.push_back(hz(rate.discrete));
      continue;
    }
    rates = {hz(rate.stepwise.min), hz(rate.stepwise.max)};
    break;
  }
  std::sort(rates.rbegin(), rates.rend());
  return rates;
}

/// The sizes of one format; of a range, its usual ones.
std::vector<Size> sizes(const SystemCalls& system, int fd, std::uint32_t fourcc) {
  constexpr Size kUsual[] = {{320, 240}, {640, 480}, {800, 600}, {1280, 720}, {1920, 1080}};
  std::vector<Size> out;
  for (std::uint32_t i = 0; i < kMost; ++i) {
    v4l2_frmsizeenum size{};
    size.index = i;
    size.pixel_format = fourcc;
    if (system.ioctl(fd, VIDIOC_ENUM_FRAMESIZES, &size) < 0) break;
    if (size.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      out.push_back({static_cast<int>(size.discrete.width), static_cast<int>(size.discrete.height)});
      continue;
    }
    const v4l2_frmsize_stepwise& range = size.stepwise;
    const auto inside = [](int value, std::uint32_t min, std::uint32_t max, std::uint32_t step) {
      const auto v = static_cast<std::uint32_t>(value);
      return v >= min && v <= max && (step == 0 || (v - min) % step == 0);
    };
    for (const Size usual : kUsual)
      if (inside(usual.width, range.min_width, range.max_width, range.step_width) &&
          inside(usual.height, range.min_height, range.max_height, range.step_height))
        out.push_back(usual);
    break;
  }
  return out;
}

bool has_rate(const CameraMode& mode, double rate_hz) {
  constexpr double kEnough = 0.95;  // 29.97 is 30
  return mode.rates_hz.empty() || mode.rates_hz.front() >= kEnough * rate_hz;
}

/// What the modes of one USB controller share; cameras elsewhere share nothing.
std::string controller(const CameraInfo& camera) {
  if (camera.bus_path.rfind("usb-", 0) != 0) return {};
  return camera.bus_path.substr(0, camera.bus_path.rfind('-'));
}

double raw_bytes_s(const CameraWish& wish) { return 2.0 * wish.size.width * wish.size.height * wish.rate_hz; }

/// What cameras can be promised of a bus in bytes a second. USB 2: one periodic endpoint moves 3 x 1024 bytes in each of 8000
/// microframes at most, and cameras reserve that much sooner than they need it; two of them do not fit the 80 % that the
/// standard lets periodic transfers have (USB 2.0, 5.6.4 and 5.9).
double bus_bytes_s(const CameraInfo& camera) { return camera.usb_mbit_s >= 5000 ? 300e6 : 3.0 * 1024 * 8000; }

}  // namespace

std::vector<CameraMode> CameraDevice::modes() const {
  std::vector<CameraMode> out;
  for (std::uint32_t i = 0; i < kMost; ++i) {
    v4l2_fmtdesc format{};
    format.index = i;
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (call(VIDIOC_ENUM_FMT, &format) < 0) break;
    for (const Size size : sizes(*system_, fd_, format.pixelformat))
      out.push_back({fourcc_text(format.pixelformat), size, rates_hz(*system_, fd_, format.pixelformat, size)});
  }
  return out;
}

Result<std::uint32_t> choose_format(const CameraInfo& camera, const CameraWish& wish, bool raw_fits) {
  const auto find = [&](bool raw, bool at_rate) -> std::uint32_t {
    for (const std::uint32_t fourcc : CameraDecoder::kFourccs)
      for (const CameraMode& mode : camera.modes)
        if (mode.format == fourcc_text(fourcc) && CameraDecoder::is_raw(fourcc) == raw && mode.size == wish.size &&
            (!at_rate || has_rate(mode, wish.rate_hz)))
          return fourcc;
    return 0;
  };
  for (const bool at_rate : {true, false})
    for (const bool raw : {raw_fits, !raw_fits})
      if (const std::uint32_t fourcc = find(raw, at_rate); fourcc != 0) return fourcc;
  std::string there;
  for (const CameraMode& mode : camera.modes)
    there += fmt::format("{}{}x{} {}", there.empty() ? "" : ", ", mode.size.width, mode.size.height, mode.format);
  return Error{ErrorCode::kUnsupported,
               fmt::format("cannot use camera {} ({}): it has no {}x{} as YUYV, UYVY, NV12 or MJPG; it has: {}", camera.path,
                           camera.name, wish.size.width, wish.size.height, there.empty() ? "nothing" : there)};
}

bool raw_fits(const CameraInfo& camera, const CameraWish& wish) {
  return controller(camera).empty() || raw_bytes_s(wish) <= bus_bytes_s(camera);
}

bool raw_fits(const CameraInfo& left, const CameraInfo& right, const CameraWish& wish) {
  const bool shared = !controller(left).empty() && controller(left) == controller(right);
  const double room = std::min(bus_bytes_s(left), bus_bytes_s(right));
  return shared ? 2 * raw_bytes_s(wish) <= room : raw_fits(left, wish) && raw_fits(right, wish);
}

Result<std::string> common_format(const CameraInfo& left, const CameraInfo& right, const CameraWish& wish) {
  if (left.path == right.path)
    return Error{ErrorCode::kBadInput, fmt::format("cannot pair camera {} with itself; name two", left.path)};
  const bool raw = raw_fits(left, right, wish);
  DUO_TRY_ASSIGN(const std::uint32_t first, choose_format(left, wish, raw));
  DUO_TRY_ASSIGN(const std::uint32_t second, choose_format(right, wish, raw));
  return first == second ? fourcc_text(first) : fourcc_text(first) + "+" + fourcc_text(second);
}

std::vector<CameraPair> camera_pairs(const std::vector<CameraInfo>& cameras, const CameraWish& wish) {
  std::vector<CameraPair> out;
  for (std::size_t left = 0; left < cameras.size(); ++left)
    for (std::size_t right = left + 1; right < cameras.size(); ++right)
      if (const auto format = common_format(cameras[left], cameras[right], wish)) out.push_back({left, right, *format});
  std::stable_partition(out.begin(), out.end(),
                        [&](const CameraPair& pair) { return cameras[pair.left].name == cameras[pair.right].name; });
  return out;
}

std::string source_name(const CameraInfo& camera) {
  const std::string device = "/dev/video";
  return camera.path.starts_with(device) ? "camera:" + camera.path.substr(device.size()) : camera.path;
}

std::string device_path(int number) { return fmt::format("/dev/video{}", number); }

std::vector<CameraInfo> list_cameras(const SystemCalls& system, std::optional<Error>* refused) {
  std::vector<CameraInfo> out;
  for (int i = 0; i < kMostDevices; ++i) {
    auto device = CameraDevice::open(system, device_path(i));
    if (device) {
      out.push_back(device->info());
      out.back().modes = device->modes();
    } else if (refused != nullptr && !*refused && device.error().code == ErrorCode::kBadInput) {
      *refused = device.error();
    }
  }
  return out;
}

Result<std::vector<CameraInfo>> find_cameras(const SystemCalls& system) {
  std::optional<Error> refused;
  std::vector<CameraInfo> found = list_cameras(system, &refused);
  if (!found.empty()) return found;
  if (refused) return *refused;
  return Error{ErrorCode::kNotFound,
               "no camera found; plug one in, and in a virtual machine or container pass its /dev/video* through"};
}

Result<std::vector<CameraInfo>> find_cameras() { return find_cameras(linux_calls()); }

bool is_camera_name(const std::string& name) {
  return name.rfind(kPrefix, 0) == 0 || name.rfind("/dev/video", 0) == 0 || name.rfind("/dev/v4l/", 0) == 0;
}

Result<std::string> camera_path(const SystemCalls& system, const std::string& name) {
  if (name.rfind(kPrefix, 0) != 0) {
    std::error_code error;
    const auto device = std::filesystem::canonical(name, error);  // the links of /dev/v4l lead to /dev/video0
    return error ? name : device.string();
  }
  const std::string which = name.substr(sizeof kPrefix - 1);
  const bool number = !which.empty() && which.size() <= 3 &&
                      std::all_of(which.begin(), which.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (number) return device_path(std::stoi(which));
  std::string there;
  for (const CameraInfo& camera : list_cameras(system)) {
    if (camera.bus_path == which) return camera.path;
    there += (there.empty() ? "" : ", ") + camera.bus_path;
  }
  return Error{ErrorCode::kNotFound, fmt::format("no camera '{}': give camera:NUMBER or camera:BUS_PATH; on the bus: {}", which,
                                                 there.empty() ? "none" : there)};
}

}  // namespace duo
