#include <algorithm>

#include "core/check.h"
#include "stages/gaussian/gaussian.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/gaussian/gaussian_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Columns are summed into a stack buffer a chunk of the row at a time, then the buffer along x.
void gaussian_rows(View<const std::uint8_t> src, View<std::uint8_t> dst, int y_begin, int y_end) {
  constexpr int kChunk = 512;
  const hn::ScalableTag<std::uint16_t> d16;
  const hn::Rebind<std::uint8_t, decltype(d16)> d8;
  const int n = static_cast<int>(hn::Lanes(d16)), w = src.width(), h = src.height();
  // Two columns before the chunk, two after, and room for whole vectors.
  HWY_ALIGN std::uint16_t columns[kChunk + 4 + 64];
  for (int y = y_begin; y < y_end; ++y) {
    const std::uint8_t* row[5];
    for (int i = 0; i < 5; ++i) row[i] = src.row(std::clamp(y + i - 2, 0, h - 1));
    const auto column = [&](int x) {
      x = std::clamp(x, 0, w - 1);
      return static_cast<std::uint16_t>(row[0][x] + row[4][x] + 4 * (row[1][x] + row[3][x]) + 6 * row[2][x]);
    };
    for (int x0 = 0; x0 < w; x0 += kChunk) {
      const int count = std::min(kChunk, w - x0);
      int i = 0;  // columns[i] belongs to x0 + i - 2
      for (; i < count + 4 && x0 + i - 2 < 0; ++i) columns[i] = column(x0 + i - 2);
      for (; i < count + 4 && x0 + i - 2 + n <= w; i += n) {
        const auto load = [&](int k) { return hn::PromoteTo(d16, hn::LoadU(d8, row[k] + x0 + i - 2)); };
        const auto inner = hn::Add(load(1), load(3)), middle = load(2);
        const auto six = hn::Add(hn::ShiftLeft<2>(middle), hn::ShiftLeft<1>(middle));
        hn::StoreU(hn::Add(hn::Add(hn::Add(load(0), load(4)), hn::ShiftLeft<2>(inner)), six), d16, columns + i);
      }
      for (; i < count + 4; ++i) columns[i] = column(x0 + i - 2);

      std::uint8_t* out = dst.row(y) + x0;
      const auto half = hn::Set(d16, 128);
      int x = 0;
      for (; x + n <= count; x += n) {
        const auto load = [&](int k) { return hn::LoadU(d16, columns + x + k); };
        const auto inner = hn::Add(load(1), load(3)), middle = load(2);
        const auto six = hn::Add(hn::ShiftLeft<2>(middle), hn::ShiftLeft<1>(middle));
        const auto sum = hn::Add(hn::Add(hn::Add(load(0), load(4)), hn::ShiftLeft<2>(inner)), hn::Add(six, half));
        hn::StoreU(hn::TruncateTo(d8, hn::ShiftRight<8>(sum)), d8, out + x);
      }
      for (; x < count; ++x) {
        const std::uint16_t* c = columns + x;
        out[x] = static_cast<std::uint8_t>((c[0] + c[4] + 4 * (c[1] + c[3]) + 6 * c[2] + 128) >> 8);
      }
    }
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(gaussian_rows);

namespace simd {

void gaussian5x5(Pool& pool, View<const std::uint8_t> src, View<std::uint8_t> dst) {
  DUO_CHECK(src.size() == dst.size());
  const auto rows = HWY_DYNAMIC_DISPATCH(gaussian_rows);
  pool.rows(src.height(), [&](int begin, int end) { rows(src, dst, begin, end); });
}

}  // namespace simd
}  // namespace duo
#endif
