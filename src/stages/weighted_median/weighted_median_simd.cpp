#include <algorithm>

#include "core/check.h"
#include "stages/weighted_median/weighted_median.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/weighted_median/weighted_median_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

#ifndef DUO_WEIGHTED_MEDIAN_ONCE
#define DUO_WEIGHTED_MEDIAN_ONCE
namespace duo {
constexpr int kRadius = WeightedMedian::kRadius, kStep = WeightedMedian::kStep;
constexpr int kSide = 2 * kRadius / kStep + 1;
static_assert(kSide == 7, "the kernel's rows are written out");
constexpr int kMaxLanes = 32;  // pixels of a vector, at most
constexpr int kPadLeft = 32;   // no less than kRadius; 64 bytes, so that row starts are aligned
constexpr int kPadRight = kMaxLanes + kRadius;
constexpr std::int16_t kNowhere = 0x1000;  // added to a gray value, it differs from all others by more than weights reach
}  // namespace duo
#endif

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// One row of the scratch from one row of the inputs.
void pad_row(const std::uint16_t* d_q4, const std::uint8_t* gray, int w, std::int16_t* values, std::int16_t* guide) {
  for (int x = 0; x < w; ++x) {
    values[x] = static_cast<std::int16_t>(d_q4[x] ^ 0x8000);
    guide[x] = static_cast<std::int16_t>(gray[x] | (d_q4[x] == Disparity::kNone ? kNowhere : 0));
  }
  std::fill_n(guide + w, kPadRight, kNowhere);
}

/// The medians of one vector of pixels.
class Window {
  using D = hn::CappedTag<std::int16_t, kMaxLanes>;
  using DU = hn::RebindToUnsigned<D>;
  using V = hn::Vec<D>;
  using VU = hn::Vec<DU>;

 public:
  explicit Window(const simd::WeightedMedianScratch& scratch) : s_(scratch) {}

  void at_row(int y) {
    rows_ = 0;
    for (int ty = std::max(y % kStep, y - kRadius); ty <= std::min(y + kRadius, s_.size.height - 1); ty += kStep) {
      values_[rows_] = s_.values.row(ty) + kPadLeft;
      guide_[rows_++] = s_.guide.row(ty) + kPadLeft;
    }
    centre_values_ = s_.values.row(y) + kPadLeft;
    centre_guide_ = s_.guide.row(y) + kPadLeft;
  }

  /// Pixels x and following; those that are not `smoothed` keep their value.
  VU median(int x, hn::Mask<D> smoothed) {
    const D d;
    const DU du;
    V lowest, highest, weight;
    weigh(x, lowest, highest, weight);
    const auto bias = hn::Set(du, 0x8000);
    const auto own = hn::Xor(hn::BitCast(du, hn::LoadU(d, centre_values_ + x)), bias);
    const auto moves = hn::And(smoothed, hn::Gt(weight, hn::Zero(d)));
    auto low = hn::IfThenElse(hn::RebindMask(du, moves), hn::Xor(hn::BitCast(du, lowest), bias), own);
    auto high = hn::IfThenElse(hn::RebindMask(du, moves), hn::Xor(hn::BitCast(du, highest), bias), own);
    // The most that is less than half of all weight; where nothing moves, more than there is.
    const auto under_half =
        hn::IfThenElse(moves, hn::ShiftRight<1>(hn::Sub(weight, hn::Set(d, 1))), hn::Set(d, std::int16_t{0x7FFF}));
    const auto one = hn::Set(du, 1);
    while (!hn::AllTrue(du, hn::Eq(low, high))) {
      const auto middle = hn::AverageRound(low, high);  // > low unless low == high
      const auto below = hn::RebindMask(du, hn::Gt(weight_below(x, hn::BitCast(d, hn::Xor(middle, bias))), under_half));
      // A lane that has its answer has middle == low == high, and less than half below.
      high = hn::IfThenElse(below, hn::Sub(middle, one), high);
      low = hn::IfThenElse(below, low, middle);
    }
    return low;
  }

 private:
  /// Weights of all taps, the range of those that have any, the sum.
  HWY_INLINE void weigh(int x, V& lowest, V& highest, V& sum) {
    const D d;
    const hn::Repartition<std::uint8_t, D> d8;
    const auto table = hn::LoadDup128(d8, WeightedMedian::kWeights.data());
    const auto centre = hn::And(hn::LoadU(d, centre_guide_ + x), hn::Set(d, 0xFF));
    // Of a difference of 64 and more, and of all high bytes, an index that looks up 0.
    const auto limit = hn::Set(d, 64), most = hn::Set(d, 16), to_high_bit = hn::Set(d, static_cast<std::int16_t>(0x8070)),
               used_bits = hn::Set(d, static_cast<std::int16_t>(0x808F));
    lowest = hn::Set(d, std::int16_t{0x7FFF}), highest = hn::Set(d, std::int16_t{-0x8000}), sum = hn::Zero(d);
    std::int16_t* out = weights_;
    for (int row = 0; row < rows_; ++row)
      for (int dx = -kRadius; dx <= kRadius; dx += kStep, out += kMaxLanes) {
        const auto difference = hn::Abs(hn::Sub(hn::LoadU(d, guide_[row] + x + dx), centre));
        const auto near = hn::Lt(difference, limit);
        const auto index = hn::And(hn::Add(hn::Min(hn::ShiftRight<2>(difference), most), to_high_bit), used_bits);
        const auto weight = hn::BitCast(d, hn::TableLookupBytesOr0(table, hn::BitCast(d8, index)));
        hn::Store(weight, d, out);
        sum = hn::Add(sum, weight);
        const auto value = hn::LoadU(d, values_[row] + x + dx);
        lowest = min_if(near, lowest, value);
        highest = max_if(near, highest, value);
      }
  }

#if HWY_TARGET <= HWY_AVX3  // an operation under a mask is one instruction
  static HWY_INLINE V add_if(hn::Mask<D> m, V sum, V x) { return hn::IfThenElse(m, hn::Add(sum, x), sum); }
  static HWY_INLINE V min_if(hn::Mask<D> m, V least, V x) { return hn::IfThenElse(m, hn::Min(least, x), least); }
  static HWY_INLINE V max_if(hn::Mask<D> m, V most, V x) { return hn::IfThenElse(m, hn::Max(most, x), most); }
#else
  static HWY_INLINE V add_if(hn::Mask<D> m, V sum, V x) { return hn::Add(sum, hn::IfThenElseZero(m, x)); }
  static HWY_INLINE V min_if(hn::Mask<D> m, V least, V x) { return hn::Min(least, hn::IfThenElse(m, x, least)); }
  static HWY_INLINE V max_if(hn::Mask<D> m, V most, V x) { return hn::Max(most, hn::IfThenElse(m, x, most)); }
#endif

  HWY_INLINE V weight_below(int x, V limit) const {
    const D d;
    auto sum = hn::Zero(d), left = sum, right = sum;  // three that do not wait for each other
    const std::int16_t* weight = weights_;
    for (int row = 0; row < rows_; ++row, weight += kSide * kMaxLanes) {
      const std::int16_t* values = values_[row] + x - kRadius;
      const auto add_tap = [&](V& to, int i) HWY_ATTR {
        to = add_if(hn::Lt(hn::LoadU(d, values + i * kStep), limit), to, hn::Load(d, weight + i * kMaxLanes));
      };
      add_tap(sum, 0), add_tap(left, 1), add_tap(right, 2);
      add_tap(sum, 3), add_tap(left, 4), add_tap(right, 5), add_tap(sum, 6);
    }
    return hn::Add(sum, hn::Add(left, right));
  }

  const simd::WeightedMedianScratch& s_;
  int rows_ = 0;
  const std::int16_t *values_[kSide], *guide_[kSide], *centre_values_, *centre_guide_;
  HWY_ALIGN_MAX std::int16_t weights_[kSide * kSide * kMaxLanes];
};

void smooth_rows(const WeightedMedian& in, const simd::WeightedMedianScratch& s, View<std::uint16_t> dst, int y_begin,
                 int y_end) {
  const hn::CappedTag<std::int16_t, kMaxLanes> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const int n = static_cast<int>(hn::Lanes(d)), w = dst.width();
  Window window(s);
  // The last vector of a row reaches past the end of views.
  HWY_ALIGN_MAX std::uint16_t last_results[kMaxLanes];
  for (int y = y_begin; y < y_end; ++y) {
    window.at_row(y);
    for (int x = 0; x < w; x += n) {
      const int count = std::min(n, w - x);
      const auto smoothed = hn::Lt(hn::LoadU(d, s.guide.row(y) + kPadLeft + x), hn::Set(d, kNowhere));
      if (hn::AllFalse(d, smoothed)) {
        std::copy_n(in.d_q4.row(y) + x, count, dst.row(y) + x);
        continue;
      }
      const auto result = window.median(x, smoothed);
      if (count == n) {
        hn::StoreU(result, du, dst.row(y) + x);
      } else {
        hn::Store(result, du, last_results);
        std::copy_n(last_results, count, dst.row(y) + x);
      }
    }
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(pad_row);
HWY_EXPORT(smooth_rows);

namespace simd {

WeightedMedianScratch::WeightedMedianScratch(Size size_in) : most(size_in), size(size_in) {
  const Size padded{kPadLeft + size.width + kPadRight, size.height};
  values = Image<std::int16_t>(padded);
  guide = Image<std::int16_t>(padded);
  for (int y = 0; y < size.height; ++y) std::fill_n(guide.row(y), padded.width, kNowhere);
}

void weighted_median(Pool& pool, const WeightedMedian& in, WeightedMedianScratch& scratch, View<std::uint16_t> dst) {
  DUO_CHECK(in.d_q4.size() == dst.size() && in.guide.size() == dst.size());
  DUO_CHECK(dst.width() <= scratch.most.width && dst.height() <= scratch.most.height);
  scratch.size = dst.size();
  const auto pad = HWY_DYNAMIC_DISPATCH(pad_row);
  const RowBand rows = in.rows.within(dst.height()), taps = in.rows.grown(kRadius, dst.height());
  pool.rows(taps.count(), [&](int begin, int end) {
    for (int y = taps.begin + begin; y < taps.begin + end; ++y)
      pad(in.d_q4.row(y), in.guide.row(y), dst.width(), scratch.values.row(y) + kPadLeft, scratch.guide.row(y) + kPadLeft);
  });
  // Windows reach six rows up and down: only now are all of them there.
  const auto smooth = HWY_DYNAMIC_DISPATCH(smooth_rows);
  pool.rows(rows.count(), [&](int begin, int end) { smooth(in, scratch, dst, rows.begin + begin, rows.begin + end); });
}

}  // namespace simd
}  // namespace duo
#endif
