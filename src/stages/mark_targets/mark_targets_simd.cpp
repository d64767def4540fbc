#include <algorithm>

#include "core/check.h"
#include "stages/mark_targets/mark_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/mark_targets/mark_targets_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Lanes are x, 8 bits: the way around the hue circle is the lesser of both differences, which wrap at 256.
void mark_row(const MarkTargets& in, int t, const Window& window, int y, std::uint8_t* marks) {
  const hn::ScalableTag<std::uint8_t> d;
  const int n = static_cast<int>(hn::Lanes(d));
  const Target& target = in.targets[static_cast<std::size_t>(t)];
  const ColorModel& color = target.color;
  const auto bit = static_cast<std::uint8_t>(1 << t);
  const auto hue = hn::Set(d, color.hue), tolerance = hn::Set(d, color.hue_tolerance);
  const auto least_saturation = hn::Set(d, color.min_saturation), least_value = hn::Set(d, color.min_value);
  const auto at_least = [](auto a, auto b) { return hn::Eq(hn::Max(a, b), a); };
  const auto vector = [&](int x) {
    const auto here = hn::LoadU(d, in.hue.row(y) + x);
    const auto around = hn::Min(hn::Sub(here, hue), hn::Sub(hue, here));
    const auto enough = hn::And(at_least(hn::LoadU(d, in.saturation.row(y) + x), least_saturation),
                                at_least(hn::LoadU(d, in.value.row(y) + x), least_value));
    const auto mark = hn::IfThenElseZero(hn::And(enough, at_least(tolerance, around)), hn::Set(d, bit));
    hn::StoreU(hn::Or(hn::LoadU(d, marks + x), mark), d, marks + x);
  };
  if (window.width < n) {
    for (int x = window.x; x < window.x_end(); ++x)
      if (ref::fits(in, target, y, x)) marks[x] |= bit;
    return;
  }
  for (int x = window.x; x + n < window.x_end(); x += n) vector(x);
  vector(window.x_end() - n);  // overlaps the one before: the same bits again
}

void mark_rows(const MarkTargets& in, View<std::uint8_t> marks, int y_begin, int y_end) {
  for (int y = y_begin; y < y_end; ++y) {
    std::uint8_t* row = marks.row(y);
    std::fill(row, row + marks.width(), std::uint8_t{0});
    for (std::size_t t = 0; t < in.targets.size(); ++t) {
      const Window window = in.targets[t].window.within(marks.size());
      if (!window.empty() && y >= window.y && y < window.y_end()) mark_row(in, static_cast<int>(t), window, y, row);
    }
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(mark_rows);

void simd::mark_targets(Pool& pool, const MarkTargets& in, View<std::uint8_t> marks) {
  DUO_CHECK(in.hue.size() == marks.size() && in.saturation.size() == marks.size() && in.value.size() == marks.size());
  DUO_CHECK(in.targets.size() <= kMaxTargets);
  const auto rows = HWY_DYNAMIC_DISPATCH(mark_rows);
  pool.rows(marks.height(), [&](int begin, int end) { rows(in, marks, begin, end); });
}

}  // namespace duo
#endif
