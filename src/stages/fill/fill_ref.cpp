#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "core/check.h"
#include "stages/fill/fill.h"

namespace duo {

void take_filled(View<const std::uint16_t> filled, View<std::uint16_t> d_q4, View<std::uint8_t> origin) {
  DUO_CHECK(filled.size() == d_q4.size() && filled.size() == origin.size());
  for (int y = 0; y < filled.height(); ++y)
    for (int x = 0; x < filled.width(); ++x) {
      if (d_q4.at(y, x) != Disparity::kNone || filled.at(y, x) == Disparity::kNone) continue;
      d_q4.at(y, x) = filled.at(y, x);
      origin.at(y, x) = static_cast<std::uint8_t>(Origin::kFilled);
    }
}

namespace ref {
namespace {

constexpr int kShortRun = 8, kRowsAround = 4, kColumnsAround = 24, kTapStep = 2, kFewestTaps = 12, kSame_q4 = 24;

/// Disparity k columns into the run of holes beyond an end is value - slope * k, in 1/256 of 1/16 px.
struct Line {
  int value = 0, slope = 0;
  int at(int k) const { return value - slope * k; }
};

/// Of the surface at column `end`, which lies beside a run; `step` leads away from the run, 1 or -1.
Line surface_at(View<const std::uint16_t> d_q4, int y, int end, int step) {
  const int at_end = d_q4.at(y, end);
  int n = 0, sum_k = 0, sum_d = 0, sum_kk = 0, sum_kd = 0;
  for (int yy = y - kRowsAround; yy <= y + kRowsAround; yy += kTapStep) {
    if (yy < 0 || yy >= d_q4.height()) continue;
    for (int k = 0; k < kColumnsAround; k += kTapStep) {
      const int x = end + step * k;
      if (x < 0 || x >= d_q4.width() || d_q4.at(yy, x) == Disparity::kNone) break;
      const int d = d_q4.at(yy, x) - at_end;
      if (std::abs(d) > kSame_q4 + k) break;
      ++n, sum_k += k, sum_d += d, sum_kk += k * k, sum_kd += k * d;
    }
  }
  const int spread = n * sum_kk - sum_k * sum_k;
  if (n < kFewestTaps || spread == 0) return {256 * at_end, 0};
  const int slope = 256 * (n * sum_kd - sum_k * sum_d) / spread;
  return {256 * at_end + (256 * sum_d - slope * sum_k) / n, slope};
}

void fill_run(View<const std::uint16_t> src, int y, int begin, int end, int most_q4, View<std::uint16_t> dst) {
  const bool has_left = begin > 0, has_right = end < src.width(), is_short = end - begin < kShortRun;
  const auto line = [&](int x, int step) { return is_short ? Line{256 * src.at(y, x), 0} : surface_at(src, y, x, step); };
  const Line left = has_left ? line(begin - 1, -1) : Line{}, right = has_right ? line(end, 1) : Line{};
  for (int x = begin; x < end; ++x) {
    const int from_left = left.at(x - (begin - 1)), from_right = right.at(end - x);
    const int value = !has_left ? from_right : !has_right ? from_left : std::min(from_left, from_right);
    dst.at(y, x) = static_cast<std::uint16_t>(std::clamp((value + 128) >> 8, 0, most_q4));
  }
}

}  // namespace

void mark_measured(View<const std::uint16_t> d_q4, View<std::uint8_t> origin) {
  DUO_CHECK(d_q4.size() == origin.size());
  for (int y = 0; y < d_q4.height(); ++y)
    for (int x = 0; x < d_q4.width(); ++x)
      origin.at(y, x) = static_cast<std::uint8_t>(d_q4.at(y, x) == Disparity::kNone ? Origin::kNone : Origin::kMeasured);
}

void fill(View<const std::uint16_t> src, int max_disparity, View<std::uint8_t> origin, View<std::uint16_t> dst, RowBand rows) {
  DUO_CHECK(src.size() == origin.size() && src.size() == dst.size() && max_disparity >= 1);
  const int w = src.width();
  rows = rows.within(src.height());
  for (int y = rows.begin; y < rows.end; ++y) {
    std::copy_n(src.row(y), w, dst.row(y));
    std::uint8_t* from = origin.row(y);
    // Holes come in runs; what was measured between them is skipped.
    for (int end = 0; end < w;) {
      const void* hole = std::memchr(from + end, static_cast<int>(Origin::kNone), static_cast<std::size_t>(w - end));
      if (hole == nullptr) break;
      const int begin = static_cast<int>(static_cast<const std::uint8_t*>(hole) - from);
      end = begin;
      while (end < w && from[end] == static_cast<std::uint8_t>(Origin::kNone)) ++end;
      if (end - begin == w) break;
      fill_run(src, y, begin, end, 16 * (max_disparity - 1), dst);
      std::fill(from + begin, from + end, static_cast<std::uint8_t>(Origin::kFilled));
    }
  }
}

}  // namespace ref
}  // namespace duo
