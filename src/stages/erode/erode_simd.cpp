#include <algorithm>

#include "core/check.h"
#include "stages/erode/erode.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/erode/erode_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Lanes are x. A column is the AND of three rows; with four neighbours the columns beside count only in the middle row.
void erode_rows(View<const std::uint8_t> src, Neighbours neighbours, View<std::uint8_t> dst, int y_begin, int y_end) {
  const hn::ScalableTag<std::uint8_t> d;
  const int n = static_cast<int>(hn::Lanes(d)), w = src.width(), h = src.height();
  const bool eight = neighbours == Neighbours::kEight;
  for (int y = y_begin; y < y_end; ++y) {
    const std::uint8_t* up = src.row(std::max(y - 1, 0));
    const std::uint8_t* mid = src.row(y);
    const std::uint8_t* down = src.row(std::min(y + 1, h - 1));
    std::uint8_t* out = dst.row(y);
    const auto plain = [&](int x) {
      const auto beside = [&](int xx) { return eight ? up[xx] & mid[xx] & down[xx] : int{mid[xx]}; };
      out[x] =
          static_cast<std::uint8_t>(beside(std::max(x - 1, 0)) & up[x] & mid[x] & down[x] & beside(std::min(x + 1, w - 1)));
    };
    const auto column = [&](int x) {
      return hn::And(hn::And(hn::LoadU(d, up + x), hn::LoadU(d, mid + x)), hn::LoadU(d, down + x));
    };
    const auto vector = [&](int x) {
      const auto left = eight ? column(x - 1) : hn::LoadU(d, mid + x - 1);
      const auto right = eight ? column(x + 1) : hn::LoadU(d, mid + x + 1);
      hn::StoreU(hn::And(hn::And(left, right), column(x)), d, out + x);
    };
    plain(0);
    if (w < n + 2) {
      for (int x = 1; x < w; ++x) plain(x);
      continue;
    }
    for (int x = 1; x + n < w - 1; x += n) vector(x);
    vector(w - 1 - n);  // overlaps the one before: same values
    plain(w - 1);
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(erode_rows);

namespace simd {

void erode(Pool& pool, View<const std::uint8_t> src, Neighbours neighbours, View<std::uint8_t> dst) {
  DUO_CHECK(src.size() == dst.size());
  const auto rows = HWY_DYNAMIC_DISPATCH(erode_rows);
  pool.rows(src.height(), [&](int begin, int end) { rows(src, neighbours, dst, begin, end); });
}

}  // namespace simd
}  // namespace duo
#endif
