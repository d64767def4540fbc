#include <algorithm>

#include "core/check.h"
#include "core/tensor_parts.h"
#include "stages/conv_first16/conv_first16.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/conv_first16/conv_first16_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

#include "core/products-inl.h"

DUO_BEFORE_PRODUCTS();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Lanes are outputs, as in matmul16: a window's row is 9 values side by side, which are taken with the next as 5 pairs.
using FirstD = hn::CappedTag<std::int32_t, kFirstBlock>;
using FirstV = hn::Vec<FirstD>;
constexpr int kFirstLanes = static_cast<int>(hn::MaxLanes(FirstD()));
constexpr int kFirstPixels = HWY_TARGET == HWY_AVX3_DL ? 8 : 4;
constexpr int kRowPairs = kFirstPairs / 3, kPixelStep = 2 * 3;

// The rows of a window that lie in the picture.
struct WindowRows {
  const std::int16_t* first[3];
  int begin, end;
};

template <int kPixels, int kVectors>
HWY_INLINE void first_tile(const ConvFirst16& layer, const WindowRows& rows, std::ptrdiff_t x_offset, int n0, std::int16_t* y) {
  const FirstD d;
  const std::int32_t* packed[kVectors];
  FirstV bias[kVectors], shift[kVectors];
  for (int v = 0; v < kVectors; ++v) {
    const int n = n0 + v * kFirstLanes;
    packed[v] = layer.packed.data() + n / kFirstBlock * kFirstBlockWords + n % kFirstBlock;
    bias[v] = hn::LoadU(d, packed[v]);
    shift[v] = hn::LoadU(d, packed[v] + kFirstBlock);
    packed[v] += 2 * kFirstBlock;
  }
  Products<FirstD> sum[kPixels][kVectors];
  int i = rows.begin;  // at least one row of a window lies in the picture
  do {
    const std::int16_t* x = rows.first[i] + x_offset;
    for (int k = 0; k < kRowPairs; ++k) {
      FirstV weights[kVectors];
      for (int v = 0; v < kVectors; ++v) weights[v] = hn::LoadU(d, packed[v] + (i * kRowPairs + k) * kFirstBlock);
      for (int p = 0; p < kPixels; ++p) {
        const FirstV inputs = pair_at(d, x + p * kPixelStep + 2 * k);
        for (int v = 0; v < kVectors; ++v) sum[p][v].add(inputs, weights[v]);
      }
    }
  } while (++i < rows.end);
  for (int p = 0; p < kPixels; ++p) {
    FirstV total[kVectors];
    for (int v = 0; v < kVectors; ++v) total[v] = sum[p][v].sum();
    store_outputs(d, total, bias, shift, layer.range, y + static_cast<std::ptrdiff_t>(p) * layer.outputs + n0,
                  layer.outputs - n0);
  }
}

template <int kPixels>
HWY_INLINE void first_pixels(const ConvFirst16& layer, const WindowRows& rows, std::ptrdiff_t x_offset, std::int16_t* y) {
  for (int n = 0; n < layer.outputs; n += 2 * kFirstLanes)
    n + kFirstLanes < layer.outputs ? first_tile<kPixels, 2>(layer, rows, x_offset, n, y)
                                    : first_tile<kPixels, 1>(layer, rows, x_offset, n, y);
}

// A pixel whose window, with the value that completes the last pair, does not lie in its rows.
void first_border(const ConvFirst16& layer, ConstTensor16 x, const WindowRows& rows, int ox, std::int16_t* y) {
  std::int16_t window[3][2 * kRowPairs] = {};
  WindowRows copied{{window[0], window[1], window[2]}, rows.begin, rows.end};
  const int x_first = 2 * ox - layer.pad_left;
  const int begin = std::max(0, -x_first), end = std::min(3, x.width() - x_first);
  for (int i = rows.begin; i < rows.end; ++i)
    std::copy(rows.first[i] + 3 * (x_first + begin), rows.first[i] + 3 * (x_first + end), window[i] + 3 * begin);
  first_pixels<1>(layer, copied, 0, y);
}

void first_rows(const ConvFirst16& layer, ConstTensor16 x, Tensor16 y, int oy_begin, int oy_end) {
  const int width = y.width();
  const int begin = layer.pad_left, end = std::clamp((x.width() - 2 + layer.pad_left) / 2, begin, width);
  for (int oy = oy_begin; oy < oy_end; ++oy) {
    const int y_first = 2 * oy - layer.pad_top;
    WindowRows rows{{}, std::max(0, -y_first), std::min(3, x.height() - y_first)};
    for (int i = rows.begin; i < rows.end; ++i) rows.first[i] = x.pixel(y_first + i, 0);
    const auto x_offset = [&](int ox) { return std::ptrdiff_t{3} * (2 * ox - layer.pad_left); };
    int ox = begin;
    for (; ox + kFirstPixels <= end; ox += kFirstPixels) first_pixels<kFirstPixels>(layer, rows, x_offset(ox), y.pixel(oy, ox));
    for (; ox < end; ++ox) first_pixels<1>(layer, rows, x_offset(ox), y.pixel(oy, ox));
    for (int border = 0; border < begin; ++border) first_border(layer, x, rows, border, y.pixel(oy, border));
    for (int border = end; border < width; ++border) first_border(layer, x, rows, border, y.pixel(oy, border));
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(first_rows);

namespace simd {

void conv_first16(Pool& pool, const ConvFirst16& layer, ConstTensor16 x, Tensor16 y) {
  DUO_CHECK(x.channels() == 3 && y.channels() == layer.outputs && layer.packed.size() == packed_words(layer));
  DUO_CHECK(x.width() == 2 * y.width() && x.height() == 2 * y.height());
  const auto rows = HWY_DYNAMIC_DISPATCH(first_rows);
  each_tensor_row(pool, y, [&](int begin, int end) { rows(layer, x, y, begin, end); });
}

}  // namespace simd
}  // namespace duo
#endif
