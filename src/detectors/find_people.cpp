#include "detectors/find_people.h"

#include <algorithm>

#include "detectors/fixed.h"
#include "detectors/place.h"

namespace duo {
namespace {

constexpr std::size_t kMostAnchors = 28 * 28 * 2 + 14 * 14 * 2 + 7 * 7 * 6;
constexpr int kBoxValues = 12;
constexpr std::int32_t kLeastScore = 16384;  // 0.5

}  // namespace

FindPeople::FindPeople() {
  candidates_.reserve(kMostAnchors);
  found_.reserve(kMostAnchors);
}

void FindPeople::collect(const DetectorGrid& grid) {
  const int anchors = grid.scores.channels(), n = grid.scores.width();
  for (int p = 0; p < grid.scores.pixels(); ++p)
    for (int a = 0; a < anchors; ++a) {
      if (grid.scores.pixel(p)[a] < 0) continue;
      const std::int16_t* raw = grid.boxes.pixel(p) + kBoxValues * a;
      const auto value = [&](int i) { return rescaled(raw[i], grid.boxes_exponent, 8); };
      const std::int32_t x = (2 * (p % n) + 1) * (kDetectorSide * 128 / n), y = (2 * (p / n) + 1) * (kDetectorSide * 128 / n);
      Candidate c;
      c.score_q15 = sigmoid_q15(rescaled(grid.scores.pixel(p)[a], grid.scores_exponent, 7));
      c.order = static_cast<std::int32_t>(candidates_.size());
      const std::int32_t half_width = value(2) / 2, half_height = value(3) / 2;
      c.x0 = x + value(0) - half_width;
      c.x1 = x + value(0) + half_width;
      c.y0 = y + value(1) - half_height;
      c.y1 = y + value(1) + half_height;
      c.points = {x + value(4), y + value(5), x + value(6), y + value(7)};
      if (c.score_q15 >= kLeastScore && c.x0 < c.x1 && c.y0 < c.y1) candidates_.push_back(c);
    }
}

std::span<const FoundPerson> FindPeople::operator()(std::span<const DetectorGrid> grids, const TurnedSquare& crop) {
  candidates_.clear();
  found_.clear();
  for (const DetectorGrid& grid : grids) collect(grid);
  std::ranges::sort(candidates_, [](const Candidate& a, const Candidate& b) {
    return a.score_q15 != b.score_q15 ? a.score_q15 > b.score_q15 : a.order < b.order;
  });
  const auto area = [](const Candidate& c) { return std::int64_t{c.x1 - c.x0} * (c.y1 - c.y0); };
  const auto same = [&](const Candidate& a, const Candidate& b) {
    const std::int64_t width = std::min(a.x1, b.x1) - std::max(a.x0, b.x0),
                       height = std::min(a.y1, b.y1) - std::max(a.y0, b.y0);
    if (width <= 0 || height <= 0) return false;
    const std::int64_t both = width * height;
    return 10 * both > 3 * (area(a) + area(b) - both);
  };
  for (std::size_t left = 0; left < candidates_.size();) {
    const Candidate best = candidates_[left];
    std::int64_t weight = 0;
    std::array<std::int64_t, 4> sums = {};
    std::size_t kept = left;
    for (std::size_t i = left; i < candidates_.size(); ++i) {
      const Candidate c = candidates_[i];
      if (i != left && !same(best, c)) continue;
      weight += c.score_q15;
      for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += std::int64_t{c.score_q15} * c.points[k];
      // The others keep their order behind what is taken.
      std::rotate(candidates_.begin() + static_cast<std::ptrdiff_t>(kept), candidates_.begin() + static_cast<std::ptrdiff_t>(i),
                  candidates_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      ++kept;
    }
    left = kept;
    const auto mean = [&](std::size_t k) { return static_cast<std::int32_t>(rounded_quotient(sums[k], weight)); };
    const PointQ8 hips = placed(crop, {mean(0), mean(1)}, kDetectorSide), top = placed(crop, {mean(2), mean(3)}, kDetectorSide);
    found_.push_back({region_around(hips, top), static_cast<std::uint16_t>(best.score_q15)});
  }
  return found_;
}

}  // namespace duo
