#include "sources/gray_scale.h"

#include <bit>
#include <vector>

namespace duo {

void GrayScale::see(const AVFrame& frame) {
  if (!is_gray16(frame.format)) return;
  std::vector<std::int64_t> count(65536);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) ++count[gray16_at(frame, y, x)];
  const std::int64_t left_out = std::int64_t{frame.width} * frame.height / 1000;  // hot and dead pixels
  int low = 0, high = 65535;
  for (std::int64_t below = count[0]; below <= left_out && low < 65535;) below += count[static_cast<std::size_t>(++low)];
  for (std::int64_t above = count[65535]; above <= left_out && high > 0;) above += count[static_cast<std::size_t>(--high)];
  widen(low, high);
}

void GrayScale::see(const GrayScale& other) {
  if (other.low_ <= other.high_) widen(other.low_, other.high_);
}

void GrayScale::widen(int low, int high) {
  low_ = std::min(low_, low);
  high_ = std::max(high_, high);
  base_ = high_ - low_ < high_ / 4 ? low_ : 0;
  shift_ = std::max(static_cast<int>(std::bit_width(static_cast<unsigned>(high_ - base_))) - 8, 0);
}

}  // namespace duo
