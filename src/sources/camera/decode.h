// A camera's bytes as a picture.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "sources/camera/device.h"
#include "sources/libav.h"

namespace duo {

class CameraDecoder {
 public:
  /// What is read here, the better first.
  static constexpr std::array kFourccs = {fourcc_of("YUYV"), fourcc_of("UYVY"), fourcc_of("NV12"), fourcc_of("MJPG")};
  static bool is_known(std::uint32_t code);
  static bool is_raw(std::uint32_t code) { return is_known(code) && code != fourcc_of("MJPG"); }

  enum class Outcome : std::uint8_t { kWhole, kDamaged, kOtherSize };
  /// Pixels, and the JPEG where it is one. Nothing but whole pictures of the format's size come out; `into` is undefined
  /// otherwise.
  Outcome decode(const CameraFormat& format, std::string_view bytes, Picture& into);

 private:
  Outcome decode_raw(const CameraFormat& format, std::string_view bytes, Picture& into);
  Outcome decode_jpeg(const CameraFormat& format, std::string_view bytes, Picture& into);

  std::vector<std::uint8_t> raw_;  // a driver's buffer with room behind it
  av::Decoder jpeg_;
  av::Packet packet_{av_packet_alloc()};
  av::DecodedFrame frame_{av_frame_alloc()};
  av::ToRgb to_rgb_;
};

}  // namespace duo
