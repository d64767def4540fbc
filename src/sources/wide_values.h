// Values of more than eight bits as eight.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "core/libav.h"

namespace duo {

/// How a picture of 16 bits a value lies in memory.
struct WideFormat {
  int channels = 0;  // of a pixel, 0: its values have fewer bits, or lie in planes
  bool little_endian = false;
  bool coloured() const { return channels > 2; }  // of one or two the first is gray, the second one opacity
};
WideFormat wide_format(int libav_format);
inline bool is_wide(int libav_format) { return wide_format(libav_format).channels > 0; }

/// Value `channel` of a pixel.
inline std::uint16_t wide_value(const AVFrame& frame, WideFormat format, int y, int x, int channel) {
  const std::ptrdiff_t at = std::ptrdiff_t{2} * (std::ptrdiff_t{x} * format.channels + channel);
  const std::uint8_t* p = frame.data[0] + std::ptrdiff_t{y} * frame.linesize[0] + at;
  return static_cast<std::uint16_t>(format.little_endian ? p[0] | p[1] << 8 : p[0] << 8 | p[1]);
}

/// Machine cameras give 10 to 14 bits in files of 16. The values that are used, but for a thousandth at either end, become
/// 0..255 by a shift; where they begin high, as those of thermal cameras, their beginning is taken off first. Two cameras that
/// share a scale keep their brightness comparable, and all colours of a picture share one.
class WideScale {
 public:
  /// Widens the scale to what a picture of 16 bits uses; other formats change nothing.
  void see(const AVFrame& frame);
  /// Widens it to what another one covers.
  void see(const WideScale& other);
  std::uint8_t of(std::uint16_t value) const {
    return static_cast<std::uint8_t>(std::min((std::max<int>(value, base_) - base_) >> shift_, 255));
  }

 private:
  void widen(int low, int high);

  int low_ = 65535, high_ = 0;  // that were used; none yet
  int base_ = 0, shift_ = 8;
};

}  // namespace duo
