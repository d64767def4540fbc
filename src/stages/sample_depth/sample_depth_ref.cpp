#include <algorithm>
#include <vector>

#include "core/check.h"
#include "stages/sample_depth/sample_depth.h"

namespace duo::ref {

DepthSample sample_depth(View<const std::uint16_t> d_q4, const Area& area) {
  DUO_CHECK(area.marks.empty() || area.marks.size() == d_q4.size());
  DepthSample out;
  std::vector<std::uint16_t> known;
  for (int y = 0; y < d_q4.height(); ++y)
    for (int x = 0; x < d_q4.width(); ++x) {
      if (!area.contains(y, x)) continue;
      ++out.count;
      if (d_q4.at(y, x) != Disparity::kNone) known.push_back(d_q4.at(y, x));
    }
  if (known.empty()) return out;
  std::sort(known.begin(), known.end());
  const std::size_t last = known.size() - 1;
  out.known = static_cast<std::int32_t>(known.size());
  out.lower_q4 = known[last / 4];
  out.median_q4 = known[last / 2];
  out.upper_q4 = known[3 * last / 4];
  return out;
}

}  // namespace duo::ref
