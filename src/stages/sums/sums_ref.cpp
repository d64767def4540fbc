#include "stages/sums/sums.h"

#include <algorithm>
#include <limits>

#include "core/check.h"
#include "duoptic/frame.h"
#include "stages/sums/hue_circle.h"

namespace duo {

std::optional<std::uint8_t> mean_hue(const AreaSums& sums) {
  if (sums.hue_cos_q14 == 0 && sums.hue_sin_q14 == 0) return std::nullopt;
  int best = 0;
  std::int64_t most = std::numeric_limits<std::int64_t>::min();
  for (int hue = 0; hue < 256; ++hue) {
    const std::int64_t along = sums.hue_cos_q14 * hue_cos_q14(hue) + sums.hue_sin_q14 * hue_sin_q14(hue);
    if (along <= most) continue;
    most = along;
    best = hue;
  }
  return static_cast<std::uint8_t>(best);
}

namespace ref {
AreaSums sums(const Sums& in) {
  DUO_CHECK(in.area.marks.empty() || in.area.marks.size() == in.size);
  DUO_CHECK((in.hue.empty() || in.hue.size() == in.size) && (in.d_q4.empty() || in.d_q4.size() == in.size));
  AreaSums out;
  for (std::int64_t y = 0; y < in.size.height; ++y)
    for (std::int64_t x = 0; x < in.size.width; ++x) {
      const int row = static_cast<int>(y), column = static_cast<int>(x);
      if (!in.area.contains(row, column)) continue;
      if (out.count == 0) out.first = out.last = {row, column};
      out.first = {std::min(out.first.y, row), std::min(out.first.x, column)};
      out.last = {std::max(out.last.y, row), std::max(out.last.x, column)};
      out.count += 1;
      out.x += x;
      out.y += y;
      out.xx += x * x;
      out.xy += x * y;
      out.yy += y * y;
      if (!in.d_q4.empty() && in.d_q4.at(row, column) != Disparity::kNone) {
        out.known += 1;
        out.d_q4 += in.d_q4.at(row, column);
      }
      if (in.hue.empty()) continue;
      out.hue_cos_q14 += hue_cos_q14(in.hue.at(row, column));
      out.hue_sin_q14 += hue_sin_q14(in.hue.at(row, column));
    }
  return out;
}

}  // namespace ref
}  // namespace duo
