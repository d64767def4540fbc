#include <algorithm>

#include "core/check.h"
#include "stages/mark_targets/mark_targets.h"

namespace duo::ref {

bool fits(const MarkTargets& in, const Target& target, int y, int x) {
  const ColorModel& color = target.color;
  if (in.saturation.at(y, x) < color.min_saturation || in.value.at(y, x) < color.min_value) return false;
  const int around = (in.hue.at(y, x) - color.hue) & 255;
  return std::min(around, 256 - around) <= color.hue_tolerance;
}

void mark_targets(const MarkTargets& in, View<std::uint8_t> marks) {
  DUO_CHECK(in.hue.size() == marks.size() && in.saturation.size() == marks.size() && in.value.size() == marks.size());
  DUO_CHECK(in.targets.size() <= kMaxTargets);
  for (int y = 0; y < marks.height(); ++y)
    for (int x = 0; x < marks.width(); ++x) {
      int mark = 0;
      for (std::size_t t = 0; t < in.targets.size(); ++t)
        if (in.targets[t].window.contains(y, x) && fits(in, in.targets[t], y, x)) mark |= 1 << t;
      marks.at(y, x) = static_cast<std::uint8_t>(mark);
    }
}

}  // namespace duo::ref
