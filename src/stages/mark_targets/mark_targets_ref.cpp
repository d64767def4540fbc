#include <algorithm>
#include <cstdlib>

#include "core/check.h"
#include "stages/mark_targets/mark_targets.h"

namespace duo::ref {
namespace {

bool color_fits(const MarkTargets& in, const ColorModel& model, int y, int x) {
  const std::uint8_t hue = in.hue.at(y, x), saturation = in.saturation.at(y, x);
  if (saturation < model.min_saturation || in.value.at(y, x) < model.min_value) return false;
  if (model.likelihood >= 0)
    return in.likelihoods[static_cast<std::size_t>(model.likelihood)][static_cast<std::size_t>(color_bin(hue, saturation))] >=
           model.min_likelihood;
  const int around = (hue - model.hue) & 255;
  return std::min(around, 256 - around) <= model.hue_tolerance;
}

bool depth_passes(const MarkTargets& in, const DepthGate& gate, int y, int x) {
  const std::uint16_t d = in.d_q4.empty() ? Disparity::kNone : in.d_q4.at(y, x);
  if (d == Disparity::kNone) return gate.pass_unknown;
  if (d < gate.min_q4 || d > gate.max_q4) return false;
  const std::uint16_t background = in.background_q4.empty() ? Disparity::kNone : in.background_q4.at(y, x);
  return background == Disparity::kNone || std::abs(d - background) > gate.background_tolerance_q4;
}

}  // namespace

bool fits(const MarkTargets& in, const Target& target, int y, int x) {
  return color_fits(in, target.color, y, x) && depth_passes(in, target.gate, y, x);
}

void mark_targets(const MarkTargets& in, View<std::uint8_t> marks) {
  DUO_CHECK(in.hue.size() == marks.size() && in.saturation.size() == marks.size() && in.value.size() == marks.size());
  DUO_CHECK(in.d_q4.empty() || in.d_q4.size() == marks.size());
  DUO_CHECK(in.background_q4.empty() || in.background_q4.size() == marks.size());
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
