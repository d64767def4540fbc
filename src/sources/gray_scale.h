// Gray of more than eight bits as eight.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/libav.h"

namespace duo {

/// Machine cameras give 10 to 14 bits in files of 16. The values that are used, but for a thousandth at either end, become
/// 0..255 by a shift; where they begin high, as those of thermal cameras, their beginning is taken off first. Two cameras that
/// share a scale keep their brightness comparable.
class GrayScale {
 public:
  /// Widens the scale to what a picture of GRAY16LE or GRAY16BE uses; other formats change nothing.
  void see(const AVFrame& frame);
  /// Widens it to what another one covers.
  void see(const GrayScale& other);
  std::uint8_t of(std::uint16_t value) const {
    return static_cast<std::uint8_t>(std::min((std::max<int>(value, base_) - base_) >> shift_, 255));
  }

 private:
  void widen(int low, int high);

  int low_ = 65535, high_ = 0;  // that were used; none yet
  int base_ = 0, shift_ = 8;
};

inline bool is_gray16(int format) { return format == AV_PIX_FMT_GRAY16LE || format == AV_PIX_FMT_GRAY16BE; }
inline std::uint16_t gray16_at(const AVFrame& frame, int y, int x) {
  const std::uint8_t* p = frame.data[0] + std::ptrdiff_t{y} * frame.linesize[0] + std::ptrdiff_t{2} * x;
  return static_cast<std::uint16_t>(frame.format == AV_PIX_FMT_GRAY16LE ? p[0] | p[1] << 8 : p[0] << 8 | p[1]);
}

}  // namespace duo
