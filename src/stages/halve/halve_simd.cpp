#include <algorithm>

#include "core/check.h"
#include "stages/halve/halve.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/halve/halve_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Lanes are x of dst. `Vector` and `plain` give one result from the four pixels of a 2x2 block.
template <class Vector, class Plain>
void each_2x2(View<const std::uint8_t> src, View<std::uint8_t> dst, int y_begin, int y_end, Vector vector, Plain plain) {
  const hn::ScalableTag<std::uint8_t> d;
  const int n = static_cast<int>(hn::Lanes(d)), w = dst.width();
  for (int y = y_begin; y < y_end; ++y) {
    const std::uint8_t* up = src.row(2 * y);
    const std::uint8_t* down = src.row(std::min(2 * y + 1, src.height() - 1));
    std::uint8_t* out = dst.row(y);
    int x = 0;
    for (; 2 * (x + n) <= src.width(); x += n) {
      hn::Vec<decltype(d)> a, b, c, e;
      hn::LoadInterleaved2(d, up + 2 * x, a, b);
      hn::LoadInterleaved2(d, down + 2 * x, c, e);
      hn::StoreU(vector(a, b, c, e), d, out + x);
    }
    for (; x < w; ++x) {
      const int x1 = std::min(2 * x + 1, src.width() - 1);
      out[x] = static_cast<std::uint8_t>(plain(up[2 * x], up[x1], down[2 * x], down[x1]));
    }
  }
}

void halve_rows(View<const std::uint8_t> src, View<std::uint8_t> dst, int y_begin, int y_end) {
  const auto mean = [](auto a, auto b, auto c, auto e) HWY_ATTR {
    // Two rounded-up means, then their mean, is too large by the bits lost: the 8-bit form of (a+b+c+e+2) >> 2.
    const hn::ScalableTag<std::uint8_t> d;
    const auto one = hn::Set(d, 1);
    const auto ab = hn::AverageRound(a, b), ce = hn::AverageRound(c, e);
    const auto lost = hn::Or(hn::Xor(a, b), hn::Xor(c, e));
    return hn::Sub(hn::AverageRound(ab, ce), hn::And(hn::And(lost, hn::Xor(ab, ce)), one));
  };
  each_2x2(src, dst, y_begin, y_end, mean, [](int a, int b, int c, int e) { return (a + b + c + e + 2) >> 2; });
}

void halve_inside_rows(View<const std::uint8_t> src, View<std::uint8_t> dst, int y_begin, int y_end) {
  const auto all = [](auto a, auto b, auto c, auto e) HWY_ATTR { return hn::And(hn::And(a, b), hn::And(c, e)); };
  each_2x2(src, dst, y_begin, y_end, all, [](int a, int b, int c, int e) { return a & b & c & e; });
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(halve_rows);
HWY_EXPORT(halve_inside_rows);

namespace simd {

void halve(Pool& pool, View<const std::uint8_t> src, View<std::uint8_t> dst) {
  DUO_CHECK(dst.size() == half_of(src.size()));
  const auto rows = HWY_DYNAMIC_DISPATCH(halve_rows);
  pool.rows(dst.height(), [&](int begin, int end) { rows(src, dst, begin, end); });
}

void halve_inside(Pool& pool, View<const std::uint8_t> src, View<std::uint8_t> dst) {
  DUO_CHECK(dst.size() == half_of(src.size()));
  const auto rows = HWY_DYNAMIC_DISPATCH(halve_inside_rows);
  pool.rows(dst.height(), [&](int begin, int end) { rows(src, dst, begin, end); });
}

}  // namespace simd
}  // namespace duo
#endif
