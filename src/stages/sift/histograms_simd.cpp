// Lanes are samples along x: their shares are worked out in vectors, then added one by one.

#include "stages/sift/histograms_simd.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/sift/histograms_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using DF = hn::CappedTag<float, 16>;
using DI = hn::RebindToSigned<DF>;

/// To the nearest, halves to even, for values in [0, 2^23): added to 2^23 they are the last bits of the sum.
HWY_INLINE hn::VFromD<DI> rounded(hn::VFromD<DF> value) {
  const auto sum = hn::Add(value, hn::Set(DF(), 8388608.0f));
  return hn::Sub(hn::BitCast(DI(), sum), hn::Set(DI(), 0x4B000000));
}

void sift_directions(const sift::Gradient& gradient, const sift::Neighbourhood& around, std::int32_t* histogram) {
  const DF d;
  const DI di;
  const int n = static_cast<int>(hn::Lanes(d));
  HWY_ALIGN_MAX std::int32_t direction[16], value[16];
  std::int32_t bins[sift::kDirections + 1] = {};  // the last is the first again
  for (int y = around.y_begin; y < around.y_end; ++y) {
    const float *magnitude = gradient.magnitude.row(y), *turns = gradient.turns.row(y);
    const auto y_weight = hn::Set(d, around.y_weight[y - around.y_begin]);
    for (int x = around.x_begin; x < around.x_end; x += n) {
      const auto weight = hn::LoadU(d, around.x_weight + (x - around.x_begin));
      hn::Store(rounded(hn::Mul(hn::Mul(hn::LoadU(d, magnitude + x), y_weight), weight)), di, value);
      hn::Store(rounded(hn::Mul(hn::LoadU(d, turns + x), hn::Set(d, static_cast<float>(sift::kDirections)))), di, direction);
      const int count = std::min(n, around.x_end - x);
      for (int i = 0; i < count; ++i) bins[direction[i]] += value[i];
    }
  }
  bins[0] += bins[sift::kDirections];
  for (int i = 0; i < sift::kDirections; ++i) histogram[i] += bins[i];
}

/// Columns of row dy that can lie in the turned square of cells: a pixel more than the exact bounds, as each sample is tested.
HWY_INLINE void narrow(float step, float offset, float x, int& begin, int& end) {
  constexpr float kFlat = 1e-3f;
  constexpr float kHalf = (sift::kCells + 1) * 0.5f;
  if (std::abs(step) < kFlat) return;
  const float a = (-kHalf - offset) / step + x, b = (kHalf - offset) / step + x;
  begin = std::max(begin, static_cast<int>(std::max(std::min(a, b), 0.0f)) - 1);
  end = std::min(end, static_cast<int>(std::max(std::max(a, b), 0.0f)) + 2);
}

void sift_cells(const sift::Gradient& gradient, const sift::Neighbourhood& around, const sift::CellFrame& frame,
                std::int32_t* histogram) {
  constexpr int kDirections = sift::kCellDirections, kRow = sift::kBins * kDirections;
  const DF d;
  const DI di;
  const int n = static_cast<int>(hn::Lanes(d));
  const auto shift = hn::Set(d, (sift::kCells + 1) * 0.5f), beyond = hn::Set(d, sift::kCells + 1.0f), zero = hn::Zero(d);
  const auto eight = hn::Set(d, static_cast<float>(kDirections));
  const auto cos = hn::Set(d, frame.cos), sin = hn::Set(d, frame.sin), turned = hn::Set(d, frame.turns);
  HWY_ALIGN_MAX std::int32_t low[16], high[16], share[8][16];  // bins of the two directions in the first of four cells
  for (int y = around.y_begin; y < around.y_end; ++y) {
    const float dy = static_cast<float>(y) - around.y;
    const auto dy_sin = hn::Set(d, dy * frame.sin), dy_cos = hn::Set(d, dy * frame.cos);
    const float *magnitude = gradient.magnitude.row(y), *turns = gradient.turns.row(y);
    const auto y_weight = hn::Set(d, around.y_weight[y - around.y_begin]);
    int begin = around.x_begin, end = around.x_end;
    narrow(frame.cos, dy * frame.sin, around.x, begin, end);
    narrow(-frame.sin, dy * frame.cos, around.x, begin, end);
    for (int x = begin; x < end; x += n) {
      const auto dx = hn::Sub(hn::ConvertTo(d, hn::Iota(di, x)), hn::Set(d, around.x));
      const auto column = hn::Add(hn::Add(hn::Mul(dx, cos), dy_sin), shift),
                 row = hn::Add(hn::Sub(dy_cos, hn::Mul(dx, sin)), shift);
      const auto in_columns = hn::And(hn::Gt(column, zero), hn::Lt(column, beyond));
      const auto in_rows = hn::And(hn::Gt(row, zero), hn::Lt(row, beyond));
      const auto inside = hn::And(hn::And(in_columns, in_rows), hn::FirstN(d, static_cast<std::size_t>(end - x)));
      if (hn::AllFalse(d, inside)) continue;
      auto direction = hn::Mul(hn::Sub(hn::LoadU(d, turns + x), turned), eight);
      direction = hn::IfThenElse(hn::Lt(direction, zero), hn::Add(direction, eight), direction);

      const auto c = hn::ConvertTo(di, column), r = hn::ConvertTo(di, row), o = hn::ConvertTo(di, direction);
      const auto mask = hn::RebindMask(di, inside);
      const auto cell = hn::Add(hn::Mul(r, hn::Set(di, kRow)), hn::ShiftLeft<3>(c));
      const auto seven = hn::Set(di, kDirections - 1);
      hn::Store(hn::IfThenElseZero(mask, hn::Add(cell, hn::And(o, seven))), di, low);
      hn::Store(hn::IfThenElseZero(mask, hn::Add(cell, hn::And(hn::Add(o, hn::Set(di, 1)), seven))), di, high);

      const auto one = hn::Set(d, 1.0f);
      const auto to_c = hn::Sub(column, hn::ConvertTo(d, c)), to_r = hn::Sub(row, hn::ConvertTo(d, r));
      const auto to_d = hn::Sub(direction, hn::ConvertTo(d, o));
      const auto weight = hn::LoadU(d, around.x_weight + (x - around.x_begin));
      const auto value = hn::IfThenElseZero(inside, hn::Mul(hn::Mul(hn::LoadU(d, magnitude + x), y_weight), weight));
      for (int i = 0; i < 4; ++i) {
        const auto in_row = hn::Mul(value, (i & 2) ? to_r : hn::Sub(one, to_r));
        const auto in_cell = hn::Mul(in_row, (i & 1) ? to_c : hn::Sub(one, to_c));
        hn::Store(rounded(hn::Mul(in_cell, hn::Sub(one, to_d))), di, share[2 * i]);
        hn::Store(rounded(hn::Mul(in_cell, to_d)), di, share[2 * i + 1]);
      }
      const int count = std::min(n, end - x);
      for (int i = 0; i < count; ++i) {
        std::int32_t *const a = histogram + low[i], *const b = histogram + high[i];
        a[0] += share[0][i];
        b[0] += share[1][i];
        a[kDirections] += share[2][i];
        b[kDirections] += share[3][i];
        a[kRow] += share[4][i];
        b[kRow] += share[5][i];
        a[kRow + kDirections] += share[6][i];
        b[kRow + kDirections] += share[7][i];
      }
    }
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(sift_directions);
HWY_EXPORT(sift_cells);

namespace sift {
decltype(Kernels::directions) directions_simd() { return HWY_DYNAMIC_DISPATCH(sift_directions); }
decltype(Kernels::cells) cells_simd() { return HWY_DYNAMIC_DISPATCH(sift_cells); }
}  // namespace sift
}  // namespace duo
#endif
