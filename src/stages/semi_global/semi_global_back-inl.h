// A row's way back. Included once for each instruction set.

#include <bit>
#include <cstring>

#include "stages/semi_global/semi_global_along-inl.h"

#if defined(DUO_SEMI_GLOBAL_BACK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DUO_SEMI_GLOBAL_BACK_INL_H
#undef DUO_SEMI_GLOBAL_BACK_INL_H
#else
#define DUO_SEMI_GLOBAL_BACK_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {

/// The same row on its way back, the other way than along it: adds the last path and picks the winners. A half's begins with
/// what the other half's way along ended with.
template <int kStep>
class Back {
 public:
  /// `used`: otherwise pixel() is never called.
  Back(const Sweep& sweep, int y, Scratch::Row& row, bool used)
      : sweep_(sweep),
        row_(row),
        y_(y),
        gray_(sweep.in.left.value[0].row(y)),
        before_(row.back.row(0) + kGap),
        here_(row.back.row(1) + kGap),
        winners_(sweep.out.left.row(y)),
        higher_(row.beside.row(0)),
        lower_(row.beside.row(1)),
        margins_(sweep.out.margin.empty() ? nullptr : sweep.out.margin.row(y)) {
    if (!used) return;
    const Part& part = sweep.part;
    if (part.facing == nullptr) {
      zero_cell(sweep, before_);
    } else {
      std::memcpy(before_ + sweep.first, sweep.s.met(kStep > 0 ? 0 : 1, y) + sweep.first,
                  static_cast<std::size_t>(sweep.lanes - sweep.first));
      least_ = sweep.s.met_least.row(kStep > 0 ? 0 : 1)[y];
    }
    const auto seen = static_cast<std::size_t>(sweep.lanes + part.width());
    std::memset(row.best.row(0) + part.begin, 255, seen);
    if (kStep > 0) std::memset(row.winner.row(0) + part.begin, 0, seen);
  }

  template <int kVectors>
  HWY_INLINE void pixel(int x) {
    const D d;
    const int lanes = lanes_of<kVectors>(sweep_);
    const Before from_side = before(sweep_, before_, &least_, gray_[x], gray_[x - kStep]);
    const std::ptrdiff_t cell = static_cast<std::ptrdiff_t>(x) * lanes;
    const std::uint8_t *const sums = row_.sums.row(0) + cell, *const costs = row_.costs.row(0) + cell;
    // Of the right pixel x - d: lane 0 is x + 1 - lanes, and both rows begin `lanes` before x = 0.
    std::uint8_t *const best = row_.best.row(0) + x + 1, *const winner = row_.winner.row(0) + x + 1;
    std::uint8_t *const here = here_, *const totals = row_.totals.row(0) + kGap;
    auto least_side = set(255), least_total = least_side;
    each_vector<kVectors>(sweep_, [&](int j, auto unused) HWY_ATTR {
      const auto l = from_side.template step<decltype(unused)::value>(j, hn::Load(d, costs + j));
      hn::Store(l, d, here + j);
      least_side = hn::Min(least_side, l);
      const auto total = hn::SaturatedAdd(hn::Load(d, sums + j), l);
      hn::Store(total, d, totals + j);
      least_total = hn::Min(least_total, total);
      // Where x falls, so does d of the same right pixel: an equal one replaces it. Where x rises, none does.
      const auto best_before = hn::LoadU(d, best + j), best_now = hn::Min(total, best_before);
      const auto disparity = hn::Load(d, sweep_.disparities + j), winner_before = hn::LoadU(d, winner + j);
      hn::StoreU(best_now, d, best + j);
      hn::StoreU(kStep < 0 ? hn::IfThenElse(hn::Eq(best_now, total), disparity, winner_before)
                           : hn::IfThenElse(hn::Eq(best_now, best_before), winner_before, disparity),
                 d, winner + j);
    });
    const int pair = least(d, least_side, least_total);
    least_ = static_cast<std::uint8_t>(first_of(pair));
    pick<kVectors>(x, totals, second_of(pair));
    std::swap(before_, here_);
  }

  void finish() {
    const Part& part = sweep_.part;
    const int lanes = sweep_.lanes;
    std::int16_t* out = sweep_.out.right.row(y_);
    const std::uint8_t *winner = row_.winner.row(0) + lanes, *best = row_.best.row(0) + lanes;
    for (int x = part.begin; x < part.end; ++x) out[x] = winner[x];
    // Left of the middle both halves have candidates.
    const auto keep = [&](Image<std::uint8_t>& image, const std::uint8_t* of, int middle) {
      std::memcpy(image.row(y_), of + middle - lanes, static_cast<std::size_t>(lanes));
    };
    if (part.facing != nullptr && kStep < 0) keep(sweep_.s.left_best, best, part.end);
    if (part.facing != nullptr && kStep > 0) {
      keep(sweep_.s.right_best, best, part.begin);
      keep(sweep_.s.right_winner, winner, part.begin);
    }
    interpolate();
  }

 private:
  /// The left winner of a pixel: the last lane that holds the least.
  template <int kVectors>
  HWY_INLINE void pick(int x, const std::uint8_t* totals, int least_total) {
    const D d;
    const int n = static_cast<int>(hn::Lanes(d)), lanes = lanes_of<kVectors>(sweep_);
    int lane = 0;
    for (int j = first_lane<kVectors>(sweep_); j < lanes; j += n) {
      std::uint64_t bits = 0;
      hn::StoreMaskBits(d, hn::Eq(hn::Load(d, totals + j), set(least_total)), reinterpret_cast<std::uint8_t*>(&bits));
      lane = bits != 0 ? j + 63 - std::countl_zero(bits) : lane;
    }
    winners_[x] = static_cast<std::int16_t>(lanes - 1 - lane);
    higher_[x] = static_cast<std::uint8_t>(totals[lane + 1] - least_total);
    lower_[x] = static_cast<std::uint8_t>(totals[lane - 1] - least_total);
    if (margins_ != nullptr) margins_[x] = static_cast<std::uint8_t>(margin<kVectors>(totals, lane, least_total));
  }

  /// The sub-pixel offsets of a row.
  void interpolate() {
    const hn::ScalableTag<std::int32_t> many;
    const hn::CappedTag<std::int32_t, 1> one;
    const int n = static_cast<int>(hn::Lanes(many));
    int x = sweep_.part.begin;
    for (; x + n <= sweep_.part.end; x += n) interpolate(many, x);
    for (; x < sweep_.part.end; ++x) interpolate(one, x);
  }

  /// Every number is whole and below 2^24, and a quotient that is not whole stays more than half a float's step below the next
  /// whole number: no rounding shows.
  template <class D32>
  HWY_INLINE void interpolate(D32 d, int x) {
    const hn::Rebind<std::int16_t, D32> d16;
    const hn::Rebind<std::uint16_t, D32> du16;
    const hn::Rebind<std::uint8_t, D32> d8;
    const hn::Rebind<float, D32> df;
    const auto constant = [&](int v) HWY_ATTR { return hn::Set(d, v); };
    const auto disparity = hn::PromoteTo(d, hn::LoadU(d16, sweep_.out.left.row(y_) + x));
    const auto below = hn::PromoteTo(d, hn::LoadU(d8, row_.beside.row(0) + x)),
               beyond = hn::PromoteTo(d, hn::LoadU(d8, row_.beside.row(1) + x));
    const auto higher = hn::Max(below, beyond), both = hn::Add(below, beyond), height = hn::Mul(higher, both);
    const auto slope = hn::Add(hn::ShiftLeft<7>(hn::Mul(hn::Sub(higher, hn::Min(below, beyond)), hn::Add(higher, both))),
                               hn::ShiftRight<1>(height));
    const auto t = hn::ConvertTo(d, hn::Div(hn::ConvertTo(df, slope), hn::ConvertTo(df, hn::Max(height, constant(1)))));
    const auto size = hn::ShiftRight<14>(hn::Add(hn::Mul(t, hn::Sub(constant(768), t)), constant(8192)));
    const auto offset = hn::IfThenElse(hn::Lt(below, beyond), hn::Neg(size), size);
    const auto inner = hn::And(hn::Gt(disparity, constant(0)), hn::Lt(disparity, constant(sweep_.in.max_disparity - 1)));
    const auto fine = hn::Add(hn::ShiftLeft<4>(disparity), hn::IfThenElseZero(inner, offset));
    hn::StoreU(hn::DemoteTo(du16, fine), du16, sweep_.out.fine.row(y_) + x);
  }

  /// The winner and its neighbours do not count. They are told by their lanes: overwritten in memory, they would have to be
  /// there before whole vectors of them could be loaded again.
  template <int kVectors>
  HWY_INLINE int margin(const std::uint8_t* totals, int lane, int least_total) const {
    const D d;
    auto second = set(255);
    const auto winner = set(lanes_of<kVectors>(sweep_) - 1 - lane), one = set(1);
    each_vector<kVectors>(sweep_, [&](int j, auto) HWY_ATTR {
      const auto disparity = hn::Load(d, sweep_.disparities + j);
      const auto beside = hn::Or(hn::SaturatedSub(disparity, winner), hn::SaturatedSub(winner, disparity));
      const auto is_near = hn::VecFromMask(d, hn::Eq(hn::Min(beside, one), beside));
      second = hn::Min(second, hn::Or(is_near, hn::Load(d, totals + j)));
    });
    return first_of(least(d, second, second)) - least_total;
  }

  const Sweep& sweep_;
  Scratch::Row& row_;
  int y_;
  const std::uint8_t* gray_;
  std::uint8_t *before_, *here_;
  std::int16_t* winners_;
  std::uint8_t *higher_, *lower_, *margins_;
  std::uint8_t least_ = 0;
};

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
