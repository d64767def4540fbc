#include "sources/wide_values.h"

#include <bit>
#include <vector>

namespace duo {

WideFormat wide_format(int libav_format) {
  switch (libav_format) {
    case AV_PIX_FMT_GRAY16LE:
      return {1, true};
    case AV_PIX_FMT_GRAY16BE:
      return {1, false};
    case AV_PIX_FMT_YA16LE:
      return {2, true};
    case AV_PIX_FMT_YA16BE:
      return {2, false};
    case AV_PIX_FMT_RGB48LE:
      return {3, true};
    case AV_PIX_FMT_RGB48BE:
      return {3, false};
    case AV_PIX_FMT_RGBA64LE:
      return {4, true};
    case AV_PIX_FMT_RGBA64BE:
      return {4, false};
    default:
      return {};
  }
}

void WideScale::see(const AVFrame& frame) {
  const WideFormat format = wide_format(frame.format);
  if (format.channels == 0) return;
  const int used = format.coloured() ? 3 : 1;
  std::vector<std::int64_t> count(65536);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x)
      for (int c = 0; c < used; ++c) ++count[wide_value(frame, format, y, x, c)];
  const std::int64_t left_out = std::int64_t{frame.width} * frame.height * used / 1000;  // hot and dead pixels
  int low = 0, high = 65535;
  for (std::int64_t below = count[0]; below <= left_out && low < 65535;) below += count[static_cast<std::size_t>(++low)];
  for (std::int64_t above = count[65535]; above <= left_out && high > 0;) above += count[static_cast<std::size_t>(--high)];
  widen(low, high);
}

void WideScale::see(const WideScale& other) {
  if (other.low_ <= other.high_) widen(other.low_, other.high_);
}

void WideScale::widen(int low, int high) {
  low_ = std::min(low_, low);
  high_ = std::max(high_, high);
  base_ = high_ - low_ < high_ / 4 ? low_ : 0;
  shift_ = std::max(static_cast<int>(std::bit_width(static_cast<unsigned>(high_ - base_))) - 8, 0);
}

}  // namespace duo
