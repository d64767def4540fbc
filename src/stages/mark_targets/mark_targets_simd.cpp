#include <algorithm>
#include <array>

#include "core/check.h"
#include "stages/mark_targets/mark_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/mark_targets/mark_targets_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

#ifndef DUO_MARK_TARGETS_TABLE
#define DUO_MARK_TARGETS_TABLE
namespace duo {
/// The decisions of all targets that have a likelihood table, so that one look-up a pixel serves them together.
struct LikelihoodBits {
  std::array<std::uint8_t, kColorBins> bits{};         // bit t of a bin: likely enough for target t
  int x_begin = 0, x_end = 0, y_begin = 0, y_end = 0;  // all their windows
};
}  // namespace duo
#endif

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Lanes are x, 16 bits for the disparity. For a target with a table its bit stands in the marks already and stays or goes.
void mark_row(const MarkTargets& in, int t, const Window& window, int y, std::uint8_t* marks) {
  const hn::ScalableTag<std::uint16_t> d16;
  const hn::Rebind<std::uint8_t, decltype(d16)> d8;
  const int n = static_cast<int>(hn::Lanes(d16));
  const Target& target = in.targets[static_cast<std::size_t>(t)];
  const ColorModel& color = target.color;
  const DepthGate& gate = target.gate;
  const auto set = [&](int value) { return hn::Set(d16, static_cast<std::uint16_t>(value)); };
  const auto bit = set(1 << t), none = set(Disparity::kNone);
  const auto keeps_unknown = gate.pass_unknown ? none : hn::Zero(d16);
  // |differences| reach 65535 - 1, so greater tolerances need not be told apart.
  const bool in_front = !in.background_q4.empty() && !in.d_q4.empty() && gate.background_tolerance_q4 >= 0;
  const auto tolerance = set(std::min(gate.background_tolerance_q4, 0xFFFF));

  const auto at_least = [](auto a, auto b) { return hn::Eq(hn::Max(a, b), a); };
  const auto at_most = [](auto a, auto b) { return hn::Eq(hn::Min(a, b), a); };
  const auto color_fits = [&](int x, auto before) {
    const auto enough =
        hn::And(at_least(hn::PromoteTo(d16, hn::LoadU(d8, in.saturation.row(y) + x)), set(color.min_saturation)),
                at_least(hn::PromoteTo(d16, hn::LoadU(d8, in.value.row(y) + x)), set(color.min_value)));
    if (color.likelihood >= 0) return hn::And(enough, hn::Ne(hn::And(before, bit), hn::Zero(d16)));
    const auto hue = hn::PromoteTo(d16, hn::LoadU(d8, in.hue.row(y) + x));
    const auto around = hn::And(hn::Sub(hue, set(color.hue)), set(255));
    return hn::And(enough, at_most(hn::Min(around, hn::Sub(set(256), around)), set(color.hue_tolerance)));
  };
  const auto depth_passes = [&](int x) {
    if (in.d_q4.empty()) return hn::Eq(keeps_unknown, none);
    const auto d = hn::LoadU(d16, in.d_q4.row(y) + x);
    const auto unknown = hn::Eq(d, none);
    auto passes = hn::And(at_least(d, set(gate.min_q4)), at_most(d, set(gate.max_q4)));
    if (in_front) {
      const auto b = hn::LoadU(d16, in.background_q4.row(y) + x);
      const auto difference = hn::Or(hn::SaturatedSub(d, b), hn::SaturatedSub(b, d));
      passes = hn::And(passes, hn::Or(hn::Eq(b, none), hn::Gt(difference, tolerance)));
    }
    const auto passes_known = hn::IfThenElseZero(passes, none);
    return hn::Eq(hn::IfThenElse(unknown, keeps_unknown, passes_known), none);
  };
  const auto vector = [&](int x) {
    const auto before = hn::PromoteTo(d16, hn::LoadU(d8, marks + x));
    const auto fits = hn::And(color_fits(x, before), depth_passes(x));
    const auto after = hn::Or(hn::AndNot(bit, before), hn::IfThenElseZero(fits, bit));
    hn::StoreU(hn::TruncateTo(d8, after), d8, marks + x);
  };
  if (window.width < n) {
    const int mask = 1 << t;
    for (int x = window.x; x < window.x_end(); ++x)
      marks[x] = static_cast<std::uint8_t>((marks[x] & ~mask) | (ref::fits(in, target, y, x) ? mask : 0));
    return;
  }
  for (int x = window.x; x + n < window.x_end(); x += n) vector(x);
  vector(window.x_end() -
         n);  // overlaps the one before: the same values, for a bit that went stays away and one that stayed fits
}

void mark_rows(const MarkTargets& in, const LikelihoodBits& table, View<std::uint8_t> marks, int y_begin, int y_end) {
  const int w = marks.width(), targets = static_cast<int>(in.targets.size());
  for (int y = y_begin; y < y_end; ++y) {
    std::uint8_t* row = marks.row(y);
    std::fill(row, row + w, std::uint8_t{0});
    if (y >= table.y_begin && y < table.y_end) {
      const std::uint8_t *hue = in.hue.row(y), *saturation = in.saturation.row(y);
      for (int x = table.x_begin; x < table.x_end; ++x)
        row[x] = table.bits[static_cast<std::size_t>(color_bin(hue[x], saturation[x]))];
    }
    for (int t = 0; t < targets; ++t) {
      const Target& target = in.targets[static_cast<std::size_t>(t)];
      const Window window = target.window.within(marks.size());
      const bool here = !window.empty() && y >= window.y && y < window.y_end();
      if (here) mark_row(in, t, window, y, row);
      if (target.color.likelihood < 0) continue;
      const auto others = static_cast<std::uint8_t>(~(1 << t));
      const int begin = here ? window.x : table.x_end, end = here ? window.x_end() : table.x_end;
      for (int x = table.x_begin; x < begin; ++x) row[x] &= others;
      for (int x = end; x < table.x_end; ++x) row[x] &= others;
    }
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(mark_rows);

namespace simd {
namespace {

LikelihoodBits likelihood_bits(const MarkTargets& in, Size size) {
  LikelihoodBits out;
  bool any = false;
  for (std::size_t t = 0; t < in.targets.size(); ++t) {
    const ColorModel& color = in.targets[t].color;
    const Window window = in.targets[t].window.within(size);
    if (color.likelihood < 0 || window.empty()) continue;
    const ColorLikelihood& likelihood = in.likelihoods[static_cast<std::size_t>(color.likelihood)];
    for (std::size_t i = 0; i < kColorBins; ++i)
      if (likelihood[i] >= color.min_likelihood) out.bits[i] = static_cast<std::uint8_t>(out.bits[i] | 1 << t);
    out.x_begin = any ? std::min(out.x_begin, window.x) : window.x;
    out.y_begin = any ? std::min(out.y_begin, window.y) : window.y;
    out.x_end = std::max(out.x_end, window.x_end());
    out.y_end = std::max(out.y_end, window.y_end());
    any = true;
  }
  return out;
}

}  // namespace

void mark_targets(Pool& pool, const MarkTargets& in, View<std::uint8_t> marks) {
  DUO_CHECK(in.hue.size() == marks.size() && in.saturation.size() == marks.size() && in.value.size() == marks.size());
  DUO_CHECK(in.d_q4.empty() || in.d_q4.size() == marks.size());
  DUO_CHECK(in.background_q4.empty() || in.background_q4.size() == marks.size());
  DUO_CHECK(in.targets.size() <= kMaxTargets);
  const LikelihoodBits table = likelihood_bits(in, marks.size());
  const auto rows = HWY_DYNAMIC_DISPATCH(mark_rows);
  pool.rows(marks.height(), [&](int begin, int end) { rows(in, table, marks, begin, end); });
}

}  // namespace simd
}  // namespace duo
#endif
