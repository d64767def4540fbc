#include <algorithm>

#include "core/check.h"
#include "stages/match_planes/match_planes.h"

namespace duo::ref {
namespace {

template <class Pixels>
int at(const Pixels& src, int y, int x) {
  return src.at(std::clamp(y, 0, src.height() - 1), std::clamp(x, 0, src.width() - 1));
}

int sobel(View<const std::uint8_t> gray, int y, int x, bool along_x, bool whole) {
  int sum = 0;
  for (int i = -1; i <= 1; ++i) {
    const int weight = i == 0 ? 2 : 1;
    sum += along_x ? weight * (at(gray, y + i, x + 1) - at(gray, y + i, x - 1))
                   : weight * (at(gray, y + 1, x + i) - at(gray, y - 1, x + i));
  }
  return (whole ? std::clamp(sum, -127, 127) : std::clamp(sum >> 2, -63, 63)) + 128;
}

void census(View<const std::uint8_t> gray, int y, int x, int dead_zone, PlaneImages& out) {
  for (int byte = 0; byte < 2; ++byte) {
    int bits = 0;
    for (int k = 0; k < 8; ++k)
      bits |= (at(gray, y + kCensus[8 * byte + k][1], x + kCensus[8 * byte + k][0]) + dead_zone < gray.at(y, x)) << k;
    out.census[static_cast<std::size_t>(byte)].at(y, out.pad + x) = static_cast<std::uint8_t>(bits);
  }
}

void interval(View<const std::uint8_t> value, int y, int x, int wider, std::uint8_t& low, std::uint8_t& high) {
  const int v = value.at(y, x);
  int lo = v, hi = v;
  for (const int neighbour : {at(value, y, x - 1), at(value, y, x + 1), at(value, y - 1, x), at(value, y + 1, x)}) {
    lo = std::min(lo, (v + neighbour + 1) >> 1);
    hi = std::max(hi, (v + neighbour + 1) >> 1);
  }
  low = static_cast<std::uint8_t>(std::max(lo - wider, 0));
  high = static_cast<std::uint8_t>(std::min(hi + wider, 255));
}

bool all_inside(View<const std::uint8_t> inside, int y, int x) {
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i)
      if (at(inside, y + j, x + i) == 0) return false;
  return true;
}

}  // namespace

void match_planes(View<const std::uint8_t> gray, View<const std::uint8_t> inside, int dead_zone, bool clear, PlaneImages& out) {
  DUO_CHECK(gray.size() == out.size && (inside.empty() || inside.size() == out.size));
  const int w = gray.width(), h = gray.height(), pad = out.pad;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      census(gray, y, x, dead_zone, out);
      out.value[0].at(y, pad + x) = gray.at(y, x);
      out.value[1].at(y, pad + x) = static_cast<std::uint8_t>(sobel(gray, y, x, true, clear));
      out.value[2].at(y, pad + x) = static_cast<std::uint8_t>(sobel(gray, y, x, false, clear));
      out.outside.at(y, pad + x) = inside.empty() || all_inside(inside, y, x) ? 0 : 255;
    }
  for (std::size_t c = 0; c < MatchPlanes::kChannels; ++c)
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x)
        interval(out.value[c].crop(0, pad, out.size), y, x, clear && c == 0 ? kClearGrayDeadZone : 0, out.low[c].at(y, pad + x),
                 out.high[c].at(y, pad + x));
  for (int y = 0; y < h; ++y) {
    for (auto& plane : out.census) out.continue_row(plane, y);
    for (auto* planes : {&out.value, &out.low, &out.high})
      for (auto& plane : *planes) out.continue_row(plane, y);
    out.continue_row(out.outside, y);
  }
}

}  // namespace duo::ref
