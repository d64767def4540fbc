#include <limits>
#include <utility>
#include <vector>

#include "core/check.h"
#include "stages/region/region.h"

namespace duo::ref {
namespace {

/// Gives each marked pixel the label of its region, others -1, by flooding from each pixel in reading order.
Image<std::int32_t> labels_of(const Region& in, const Window& window, View<const std::uint8_t> marks) {
  const auto member = [&](int y, int x) { return (marks.at(y, x) >> in.bit & 1) != 0; };
  auto labels = Image<std::int32_t>(marks.size());
  for (int y = 0; y < marks.height(); ++y)
    for (int x = 0; x < marks.width(); ++x) labels.at(y, x) = -1;
  std::vector<std::pair<int, int>> region;
  for (int y0 = window.y; y0 < window.y_end(); ++y0)
    for (int x0 = window.x; x0 < window.x_end(); ++x0) {
      if (labels.at(y0, x0) >= 0 || !member(y0, x0)) continue;
      const int label = y0 * marks.width() + x0;
      region.assign(1, {y0, x0});
      labels.at(y0, x0) = label;
      for (std::size_t i = 0; i < region.size(); ++i) {
        const auto [y, x] = region[i];
        for (const auto& [dy, dx] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
          const int y2 = y + dy, x2 = x + dx;
          if (!window.contains(y2, x2) || labels.at(y2, x2) >= 0 || !member(y2, x2)) continue;
          labels.at(y2, x2) = label;
          region.emplace_back(y2, x2);
        }
      }
    }
  return labels;
}

}  // namespace

RegionLabel keep_region(const Region& in, View<std::uint8_t> marks) {
  DUO_CHECK(in.bit >= 0 && in.bit < 8);
  const Window window = in.window.within(marks.size());
  const Image<std::int32_t> labels = labels_of(in, window, marks);
  std::vector<std::int32_t> pixels(static_cast<std::size_t>(marks.width()) * marks.height());
  for (int y = window.y; y < window.y_end(); ++y)
    for (int x = window.x; x < window.x_end(); ++x)
      if (labels.at(y, x) >= 0) ++pixels[static_cast<std::size_t>(labels.at(y, x))];

  RegionLabel best;
  std::int64_t nearest = std::numeric_limits<std::int64_t>::max();
  for (int y = window.y; y < window.y_end(); ++y)
    for (int x = window.x; x < window.x_end(); ++x) {
      const std::int32_t label = labels.at(y, x);
      if (label < 0) continue;
      const std::int32_t count = pixels[static_cast<std::size_t>(label)];
      const std::int64_t dx = x - in.seed.x, dy = y - in.seed.y, distance2 = dx * dx + dy * dy;
      if (distance2 >= nearest) continue;
      best = {label, count};
      nearest = distance2;
    }

  for (int y = window.y; y < window.y_end(); ++y)
    for (int x = window.x; x < window.x_end(); ++x)
      if (labels.at(y, x) < 0 || labels.at(y, x) != best.label) marks.at(y, x) &= static_cast<std::uint8_t>(~(1 << in.bit));
  return best;
}

}  // namespace duo::ref
