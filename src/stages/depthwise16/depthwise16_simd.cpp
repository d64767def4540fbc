#include <algorithm>

#include "core/check.h"
#include "core/tensor_parts.h"
#include "stages/depthwise16/depthwise16.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/depthwise16/depthwise16_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

#include "core/products-inl.h"

DUO_BEFORE_PRODUCTS();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Lanes are channels. Two rows of results at once: the input rows that they need are taken in pairs, row 2i with row 2i + 1,
// whose values alternate, so that one product of pairs is two places of the window. A pair serves both results, with
// weights of its own; where a result does not need one of a pair's rows, or the picture has none there, that weight is 0 and
// the row is any of the picture.
template <int kWindow, int kStride>
struct Rows {
  static constexpr int kInputs = kStride + kWindow, kPairs = (kInputs + 1) / 2;
  /// Whether result `o` needs a row of pair `i`.
  static constexpr bool needs(int o, int i) { return 2 * i + 1 >= o * kStride && 2 * i < o * kStride + kWindow; }
};

// Weights are kept in the order that interleaving gives, first those of the lower halves.
template <int kWindow, int kStride, class D>
class ChannelGroup {
 public:
  ChannelGroup(const Depthwise16& layer, ConstTensor16 x, Tensor16 y, int c) : layer_(layer), x_(x), y_(y), c_(c) {
    for (int lane = 0; lane < kLanes / 2; ++lane)
      for (int half = 0; half < 2; ++half) {
        const int channel = c + 8 * (lane / 4) + 4 * half + lane % 4;
        bias_[half][lane] = layer.bias[channel];
        shift_[half][lane] = layer.shift[channel];
      }
  }

  // Rows oy and oy + 1, where oy_end allows it.
  void rows(int oy, int oy_end) {
    const int y_first = oy * kStride - layer_.pad_top;
    const bool inside = y_first >= 0 && y_first + kRows::kInputs <= x_.height();
    if (!inside || !filled_inside_) fill(y_first);
    filled_inside_ = inside;
    for (int row = 0; row < 2 * kRows::kPairs; ++row)
      row_[row] = x_.pixel(std::clamp(y_first + row, 0, x_.height() - 1), 0) + c_;
    std::int16_t* out[2] = {y_.pixel(oy, 0) + c_, oy + 1 < oy_end ? y_.pixel(oy + 1, 0) + c_ : nullptr};
    const int width = y_.width();
    // Columns of results whose windows lie inside.
    const int begin = std::min((layer_.pad_left + kStride - 1) / kStride, width);
    const int end = std::clamp((x_.width() - kWindow + layer_.pad_left + kStride) / kStride, begin, width);
    for (int ox = 0; ox < begin; ++ox) pixel_at_border(ox, out);
    for (int ox = begin; ox < end; ++ox) pixel(ox, out, 0, kWindow);
    for (int ox = end; ox < width; ++ox) pixel_at_border(ox, out);
  }

 private:
  using kRows = Rows<kWindow, kStride>;
  using D32 = hn::Repartition<std::int32_t, D>;
  static constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));

  void fill(int y_first) {
    const D d;
    const auto weight = [&](int o, int row, int j) HWY_ATTR {
      const int i = row - o * kStride, y = y_first + row;
      if (i < 0 || i >= kWindow || y < 0 || y >= x_.height()) return hn::Zero(d);
      return hn::LoadU(d, layer_.weights.data() + (i * kWindow + j) * layer_.channels + c_);
    };
    for (int o = 0; o < 2; ++o)
      for (int i = 0; i < kRows::kPairs; ++i)
        for (int j = 0; j < kWindow; ++j) {
          const auto even = weight(o, 2 * i, j), odd = weight(o, 2 * i + 1, j);
          hn::Store(hn::InterleaveLower(d, even, odd), d, weights_[o][i][j][0]);
          hn::Store(hn::InterleaveUpper(d, even, odd), d, weights_[o][i][j][1]);
        }
  }

  HWY_INLINE void pixel(int ox, std::int16_t* const* out, int j_begin, int j_end) const {
    const D d;
    const D32 d32;
    const std::ptrdiff_t first = (std::ptrdiff_t{ox} * kStride - layer_.pad_left) * layer_.channels;
    Products<D32> sum[2][2];
    for (int j = j_begin; j < j_end; ++j)
      for (int i = 0; i < kRows::kPairs; ++i) {
        const std::ptrdiff_t at = first + std::ptrdiff_t{j} * layer_.channels;
        const auto even = hn::LoadU(d, row_[2 * i] + at), odd = hn::LoadU(d, row_[2 * i + 1] + at);
        const auto lower = hn::BitCast(d32, hn::InterleaveLower(d, even, odd));
        const auto upper = hn::BitCast(d32, hn::InterleaveUpper(d, even, odd));
        for (int o = 0; o < 2; ++o)
          if (kRows::needs(o, i)) {
            sum[o][0].add(lower, hn::BitCast(d32, hn::Load(d, weights_[o][i][j][0])));
            sum[o][1].add(upper, hn::BitCast(d32, hn::Load(d, weights_[o][i][j][1])));
          }
      }
    const auto low = hn::Set(d, layer_.range.low), high = hn::Set(d, layer_.range.high);
    for (int o = 0; o < 2; ++o) {
      if (!out[o]) continue;
      const auto result = [&](int half) HWY_ATTR {
        return hn::Shr(hn::Add(sum[o][half].sum(), hn::Load(d32, bias_[half])), hn::Load(d32, shift_[half]));
      };
      // Puts the channels back in order; saturates, which the range makes good.
      const auto values = hn::ReorderDemote2To(d, result(0), result(1));
      hn::StoreU(hn::Clamp(values, low, high), d, out[o] + std::ptrdiff_t{ox} * layer_.channels);
    }
  }

  void pixel_at_border(int ox, std::int16_t* const* out) const {
    const int x_first = ox * kStride - layer_.pad_left;
    pixel(ox, out, std::max(0, -x_first), std::min(kWindow, x_.width() - x_first));
  }

  const Depthwise16& layer_;
  const ConstTensor16 x_;
  const Tensor16 y_;
  const int c_;
  bool filled_inside_ = false;
  const std::int16_t* row_[2 * kRows::kPairs];
  HWY_ALIGN std::int16_t weights_[2][kRows::kPairs][kWindow][2][kLanes];
  HWY_ALIGN std::int32_t bias_[2][kLanes / 2], shift_[2][kLanes / 2];
};

// Rows oy_begin .. oy_end of channels c .. c_end: as wide vectors as fit, then what fewer than 8 channels are left by the
// definition.
template <int kWindow, int kStride, class D>
void channels(D, const Depthwise16& layer, ConstTensor16 x, Tensor16 y, int oy_begin, int oy_end, int c, int c_end) {
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));
  for (; c + kLanes <= c_end; c += kLanes) {
    ChannelGroup<kWindow, kStride, D> group(layer, x, y, c);
    for (int oy = oy_begin; oy < oy_end; oy += 2) group.rows(oy, oy_end);
  }
  if (c == c_end) return;
  if constexpr (kLanes > 8)
    channels<kWindow, kStride>(hn::Half<D>(), layer, x, y, oy_begin, oy_end, c, c_end);
  else
    ref::depthwise16(layer, x, y, oy_begin, oy_end, c, c_end);
}

void depthwise_part(const Depthwise16& layer, ConstTensor16 x, Tensor16 y, int oy_begin, int oy_end, int c, int c_end) {
  const hn::CappedTag<std::int16_t, kDepthwiseGroup> d;
  const auto run = layer.window == 3 ? (layer.stride == 1 ? channels<3, 1, decltype(d)> : channels<3, 2, decltype(d)>)
                                     : (layer.stride == 1 ? channels<5, 1, decltype(d)> : channels<5, 2, decltype(d)>);
  run(d, layer, x, y, oy_begin, oy_end, c, c_end);
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(depthwise_part);

namespace simd {

void depthwise16(Pool& pool, const Depthwise16& layer, ConstTensor16 x, Tensor16 y) {
  DUO_CHECK(x.channels() == layer.channels && y.channels() == layer.channels);
  DUO_CHECK((layer.window == 3 || layer.window == 5) && (layer.stride == 1 || layer.stride == 2));
  const auto part = HWY_DYNAMIC_DISPATCH(depthwise_part);
  // Bands of so many rows of a group of channels that preparing the group's weights does not count.
  const int band = std::max(4, 128 / y.width() / 2 * 2);
  each_tensor_part(pool, y, [&](int begin, int end, int c_begin, int c_end) {
    for (int oy = begin; oy < end; oy += band)
      for (int c = c_begin; c < c_end; c += kDepthwiseGroup)
        part(layer, x, y, oy, std::min(oy + band, end), c, std::min(c + kDepthwiseGroup, c_end));
  });
}

}  // namespace simd
}  // namespace duo
#endif
