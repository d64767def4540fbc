#include <algorithm>

#include "core/check.h"
#include "core/tensor_parts.h"
#include "stages/matmul16/matmul16.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/matmul16/matmul16_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

#include "core/products-inl.h"

DUO_BEFORE_PRODUCTS();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Lanes are outputs. A tile of sums stays in registers: 4 pixels by two vectors of 16, 8 by two of 32.
using MatmulD = hn::CappedTag<std::int32_t, kMatmulBlock>;
using MatmulV = hn::Vec<MatmulD>;
constexpr int kMatmulLanes = static_cast<int>(hn::MaxLanes(MatmulD()));
constexpr int kTilePixels = HWY_TARGET == HWY_AVX3_DL ? 8 : 4;
constexpr int kPanelPixels = 64;  // so many pixels use a block's weights, one after the other
constexpr int kChunkPairs = kMatmulChunk / 2;

// Where vectors of outputs lie in the packed layer, and what they are asked for.
template <int kVectors>
struct Columns {
  const std::int32_t* bias[kVectors];
  int n, pairs, fold;
  Range16 range;

  const std::int32_t* shift(int v) const { return bias[v] + kMatmulBlock; }
  const std::int32_t* weights(int v) const { return bias[v] + 2 * kMatmulBlock; }
};

// At least one pair. A loop that may have none keeps two copies of its sums, more than there are registers.
template <int kPixels, int kVectors>
HWY_INLINE void add_pairs(const Columns<kVectors>& columns, const std::int16_t* x, std::ptrdiff_t x_step, int begin, int end,
                          MatmulV (&total)[kPixels][kVectors]) {
  const MatmulD d;
  Products<MatmulD> sum[kPixels][kVectors];
  int k = begin;
  do {
    MatmulV weights[kVectors];
    for (int v = 0; v < kVectors; ++v) weights[v] = hn::LoadU(d, columns.weights(v) + k * kMatmulBlock);
    for (int p = 0; p < kPixels; ++p) {
      const MatmulV inputs = pair_at(d, x + p * x_step + 2 * k);
      for (int v = 0; v < kVectors; ++v) sum[p][v].add(inputs, weights[v]);
    }
  } while (++k < end);
  for (int p = 0; p < kPixels; ++p)
    for (int v = 0; v < kVectors; ++v) total[p][v] = sum[p][v].sum();
}

template <int kPixels, int kVectors>
HWY_INLINE void tile(const Columns<kVectors>& columns, const std::int16_t* x, std::ptrdiff_t x_step, std::int16_t* y,
                     std::ptrdiff_t y_step, int count) {
  const MatmulD d;
  MatmulV total[kPixels][kVectors];
  if (columns.fold == 0) {  // sums wrap: all inputs are one chunk
    add_pairs(columns, x, x_step, 0, columns.pairs, total);
  } else {
    for (auto& of_pixel : total)
      for (auto& one : of_pixel) one = hn::Zero(d);
    const MatmulV half = hn::Set(d, 1 << (columns.fold - 1));
    for (int begin = 0; begin < columns.pairs; begin += kChunkPairs) {
      MatmulV sum[kPixels][kVectors];
      add_pairs(columns, x, x_step, begin, std::min(begin + kChunkPairs, columns.pairs), sum);
      for (int p = 0; p < kPixels; ++p)
        for (int v = 0; v < kVectors; ++v)
          total[p][v] = hn::Add(total[p][v], hn::ShiftRightSame(hn::Add(sum[p][v], half), columns.fold));
    }
  }
  MatmulV bias[kVectors], shift[kVectors];
  for (int v = 0; v < kVectors; ++v) {
    bias[v] = hn::LoadU(d, columns.bias[v]);
    shift[v] = hn::LoadU(d, columns.shift(v));
  }
  for (int p = 0; p < kPixels; ++p) store_outputs(d, total[p], bias, shift, columns.range, y + p * y_step, count);
}

template <int kPixels, int kVectors>
void tiles(const Matmul16& layer, ConstTensor16 x, Tensor16 y, int& p, int p_end, int n0) {
  if (p + kPixels > p_end) return;
  Columns<kVectors> columns;
  columns.pairs = layer.inputs / 2;
  columns.fold = layer.fold;
  columns.range = layer.range;
  for (int v = 0; v < kVectors; ++v) {
    const int n = n0 + v * kMatmulLanes;
    columns.bias[v] = layer.packed.data() + n / kMatmulBlock * packed_block(layer) + n % kMatmulBlock;
  }
  const int count = layer.outputs - n0;
  for (; p + kPixels <= p_end; p += kPixels)
    tile<kPixels, kVectors>(columns, x.pixel(p), x.channels(), y.pixel(p) + n0, y.channels(), count);
}

template <int kVectors>
void panel(const Matmul16& layer, ConstTensor16 x, Tensor16 y, int p, int p_end, int n) {
  if constexpr (kTilePixels > 4) tiles<kTilePixels, kVectors>(layer, x, y, p, p_end, n);
  tiles<4, kVectors>(layer, x, y, p, p_end, n);
  tiles<2, kVectors>(layer, x, y, p, p_end, n);
  tiles<1, kVectors>(layer, x, y, p, p_end, n);
}

void matmul_part(const Matmul16& layer, ConstTensor16 x, Tensor16 y, int p_begin, int p_end, int n_begin, int n_end) {
  for (int p = p_begin; p < p_end; p += kPanelPixels)
    for (int n = n_begin; n < n_end; n += 2 * kMatmulLanes) {
      const int end = std::min(p + kPanelPixels, p_end);
      n + kMatmulLanes < n_end ? panel<2>(layer, x, y, p, end, n) : panel<1>(layer, x, y, p, end, n);
    }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(matmul_part);

namespace simd {

void matmul16(Pool& pool, const Matmul16& layer, ConstTensor16 x, Tensor16 y) {
  DUO_CHECK(x.channels() == layer.inputs && y.channels() == layer.outputs && x.pixels() == y.pixels());
  DUO_CHECK(layer.inputs % 2 == 0 && layer.packed.size() == packed_words(layer));
  const auto part = HWY_DYNAMIC_DISPATCH(matmul_part);
  static_assert(kChannelGroup % kMatmulBlock == 0);
  each_tensor_part(pool, y, [&](int begin, int end, int n_begin, int n_end) {
    part(layer, x, y, begin * y.width(), end * y.width(), n_begin, n_end);
  });
}

}  // namespace simd
}  // namespace duo
#endif
