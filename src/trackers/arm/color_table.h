// Skin against cloth: the log likelihood ratio of hue-saturation bins, learnt from this person.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "trackers/arm/grid.h"

namespace duo::arm {

using Histogram = std::array<float, kColorBins>;  // sums to 1, smoothed by a 3 x 3 binomial around the hue circle

Histogram smoothed(const Histogram& counts);

/// The histogram of the cells that `use(i)` picks; none of fewer than 12 cells.
template <class Use>
std::optional<Histogram> histogram_of(const Grid& grid, Use&& use) {
  Histogram counts{};
  int n = 0;
  for (int i = 0; i < grid.size(); ++i)
    if (use(i)) {
      ++counts[grid.color_bin(i)];
      ++n;
    }
  if (n < 12) return {};
  return smoothed(counts);
}

/// log(target / surroundings), within +-4.
///
/// The target keeps a share of its first histogram for ever, so that a wrong region cannot talk it out of its colour.
/// Source  Jones, Rehg, "Statistical color models with application to skin detection", 2002
class ColorTable {
 public:
  void start(const Histogram& target, const Histogram& surroundings);
  void learn_target(const Histogram& seen, float rate);
  void learn_surroundings(const Histogram& seen, float rate);
  float operator()(std::size_t bin) const { return ratio_[bin]; }

 private:
  void update();
  Histogram first_{}, target_{}, surroundings_{}, ratio_{};
};

}  // namespace duo::arm
