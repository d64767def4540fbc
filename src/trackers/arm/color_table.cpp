#include "trackers/arm/color_table.h"

#include <algorithm>
#include <cmath>

namespace duo::arm {
namespace {

void blend(Histogram& into, const Histogram& seen, float rate) {
  for (std::size_t i = 0; i < into.size(); ++i) into[i] = (1 - rate) * into[i] + rate * seen[i];
}

}  // namespace

Histogram smoothed(const Histogram& counts) {
  Histogram out{};
  float sum = 1e-9F;
  for (int hue = 0; hue < 32; ++hue)
    for (int saturation = 0; saturation < 32; ++saturation) {
      float t = 0;
      for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j) {
          const int bin = (hue + i + 32) % 32 * 32 + std::clamp(saturation + j, 0, 31);
          t += counts[static_cast<std::size_t>(bin)] * static_cast<float>((i ? 1 : 2) * (j ? 1 : 2));
        }
      out[static_cast<std::size_t>(hue * 32 + saturation)] = t;
      sum += t;
    }
  for (float& v : out) v /= sum;
  return out;
}

void ColorTable::start(const Histogram& target, const Histogram& surroundings) {
  first_ = target_ = target;
  surroundings_ = surroundings;
  update();
}

void ColorTable::learn_target(const Histogram& seen, float rate) {
  blend(target_, seen, rate);
  update();
}

void ColorTable::learn_surroundings(const Histogram& seen, float rate) {
  blend(surroundings_, seen, rate);
  update();
}

// The constants beside the sums stand for the share of a bin never seen; the greater one below makes unknown colours unlikely.
void ColorTable::update() {
  constexpr float kFirst = 0.3F, kUnseenTarget = 1e-4F, kUnseenSurroundings = 1e-3F;
  for (std::size_t i = 0; i < ratio_.size(); ++i)
    ratio_[i] = std::clamp(
        std::log(((1 - kFirst) * target_[i] + kFirst * first_[i] + kUnseenTarget) / (surroundings_[i] + kUnseenSurroundings)),
        -4.0F, 4.0F);
}

}  // namespace duo::arm
