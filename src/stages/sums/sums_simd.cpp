// Plain rows in parallel: marks are mostly empty, which eight pixels at a time find out, and hue is a table look-up for each
// pixel that is left, so vectors would gain little.

#include "stages/sums/sums.h"

#include <algorithm>
#include <array>
#include <mutex>

#include "core/check.h"
#include "duoptic/frame.h"
#include "stages/sums/hue_circle.h"

namespace duo::simd {
namespace {

struct Direction {
  std::int16_t cos_q14, sin_q14;
};
constexpr auto kDirections = [] {
  std::array<Direction, 256> out{};
  for (int hue = 0; hue < 256; ++hue)
    out[static_cast<std::size_t>(hue)] = {static_cast<std::int16_t>(hue_cos_q14(hue)),
                                          static_cast<std::int16_t>(hue_sin_q14(hue))};
  return out;
}();

/// Row y's part of the sums: all but the terms in y.
void add_row(const Sums& in, int y, int begin, int end, AreaSums& out) {
  const std::uint8_t* hue = in.hue.empty() ? nullptr : in.hue.row(y);
  const std::uint16_t* d = in.d_q4.empty() ? nullptr : in.d_q4.row(y);
  std::int64_t count = 0, sum_x = 0, sum_xx = 0, known = 0, sum_d = 0, sum_cos = 0, sum_sin = 0;
  int first = end, last = begin;
  for (int x = in.area.next_marked(y, begin, end); x < end; x = in.area.next_marked(y, x + 1, end)) {
    first = std::min(first, x);
    last = x;
    count += 1;
    sum_x += x;
    sum_xx += std::int64_t{x} * x;
    if (d != nullptr && d[x] != Disparity::kNone) {
      known += 1;
      sum_d += d[x];
    }
    if (hue == nullptr) continue;
    sum_cos += kDirections[hue[x]].cos_q14;
    sum_sin += kDirections[hue[x]].sin_q14;
  }
  if (count == 0) return;
  if (out.count == 0) out.first = out.last = {y, first};
  out.first = {std::min(out.first.y, y), std::min(out.first.x, first)};
  out.last = {std::max(out.last.y, y), std::max(out.last.x, last)};
  out.count += count;
  out.x += sum_x;
  out.y += count * y;
  out.xx += sum_xx;
  out.xy += sum_x * y;
  out.yy += count * y * y;
  out.known += known;
  out.d_q4 += sum_d;
  out.hue_cos_q14 += sum_cos;
  out.hue_sin_q14 += sum_sin;
}

void add(const AreaSums& part, AreaSums& out) {
  if (part.count == 0) return;
  if (out.count == 0) {
    out = part;
    return;
  }
  out.first = {std::min(out.first.y, part.first.y), std::min(out.first.x, part.first.x)};
  out.last = {std::max(out.last.y, part.last.y), std::max(out.last.x, part.last.x)};
  for (const auto member : {&AreaSums::count, &AreaSums::x, &AreaSums::y, &AreaSums::xx, &AreaSums::xy, &AreaSums::yy,
                            &AreaSums::known, &AreaSums::d_q4, &AreaSums::hue_cos_q14, &AreaSums::hue_sin_q14})
    out.*member += part.*member;
}

}  // namespace

AreaSums sums(Pool& pool, const Sums& in) {
  DUO_CHECK(in.area.marks.empty() || in.area.marks.size() == in.size);
  DUO_CHECK((in.hue.empty() || in.hue.size() == in.size) && (in.d_q4.empty() || in.d_q4.size() == in.size));
  const Window bounds = in.area.bounds(in.size);
  AreaSums out;
  std::mutex merge;
  pool.rows(bounds.height, [&](int from, int to) {
    AreaSums mine;
    each_row(in.area, bounds, bounds.y + from, bounds.y + to,
             [&](int y, int begin, int end) { add_row(in, y, begin, end, mine); });
    const std::lock_guard lock(merge);
    add(mine, out);
  });
  return out;
}

}  // namespace duo::simd
