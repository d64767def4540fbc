// Neighbours mostly have few different winners: for each of them the pixels it is looked up at lie side by side.

#include <algorithm>

#include "core/check.h"
#include "stages/check_left_right/check_left_right.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/check_left_right/check_left_right_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// What is kept of one row of values; -1 elsewhere.
class CheckedRow {
  using D = hn::CappedTag<std::int16_t, 32>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;

 public:
  CheckedRow(const CheckLeftRight& in, int y)
      : in_(in),
        y_(y),
        w_(in.left.width()),
        left_(in.left.row(y)),
        right_(in.right.row(y)),
        left_inside_(in.left_inside.empty() ? nullptr : in.left_inside.row(y)),
        right_inside_(in.left_inside.empty() ? nullptr : in.right_inside.row(y)) {}

  void keep(const std::int16_t* values, std::int16_t* dst) const {
    const D d;
    const int n = static_cast<int>(hn::Lanes(d));
    for (int x = 0; x < w_; x += n) {
      if (x + n <= w_ && lies_inside(x, n)) {
        hn::StoreU(hn::IfThenElse(kept(x), hn::LoadU(d, values + x), hn::Set(d, std::int16_t{-1})), d, dst + x);
        continue;
      }
      for (int i = x; i < std::min(x + n, w_); ++i) dst[i] = ref::consistent(in_, y_, i) ? values[i] : std::int16_t{-1};
    }
  }

 private:
  /// Whether all that n pixels look up lies in the row.
  bool lies_inside(int x, int n) const {
    const D d;
    const V left = hn::LoadU(d, left_ + x), zero = hn::Zero(d);
    const int most = hn::GetLane(hn::MaxOfLanes(d, left)), least = hn::GetLane(hn::MinOfLanes(d, hn::Max(left, zero)));
    return x - most - in_.reach >= 0 && x - least + n + in_.reach <= w_;
  }

  M kept(int x) const {
    const D d;
    const V left = hn::LoadU(d, left_ + x), none = hn::Set(d, std::int16_t{-1});
    M todo = hn::Gt(left, none), out = hn::Lt(none, none);
    while (!hn::AllFalse(d, todo)) {
      const std::int16_t winner = left_[x + hn::FindFirstTrue(d, todo)];
      const M same = hn::Eq(left, hn::Set(d, winner));
      out = hn::Or(out, hn::And(same, confirmed(x, winner)));
      todo = hn::AndNot(same, todo);
    }
    return out;
  }

  /// Pixels that a winner holds for, if they have it.
  M confirmed(int x, std::int16_t winner) const {
    const D d;
    const hn::Rebind<std::uint8_t, D> d8;
    const int there = x - winner;
    const V none = hn::Set(d, std::int16_t{-1}), own = hn::Set(d, winner),
            too_far = hn::Set(d, static_cast<std::int16_t>(in_.tolerance + 1));
    M out = hn::Lt(none, none);
    for (int beside = -in_.reach; beside <= in_.reach; ++beside) {
      const V other = hn::LoadU(d, right_ + there + beside);
      out = hn::Or(out, hn::And(hn::Gt(other, none), hn::Lt(hn::Abs(hn::Sub(other, own)), too_far)));
    }
    if (left_inside_ == nullptr) return out;
    const V inside = hn::PromoteTo(d, hn::Min(hn::LoadU(d8, left_inside_ + x), hn::LoadU(d8, right_inside_ + there)));
    return hn::And(out, hn::Gt(inside, hn::Zero(d)));
  }

  const CheckLeftRight& in_;
  int y_, w_;
  const std::int16_t *left_, *right_;
  const std::uint8_t *left_inside_, *right_inside_;
};

void check_rows(const CheckLeftRight& in, View<const std::int16_t> values, View<std::int16_t> dst, int begin, int end) {
  for (int y = begin; y < end; ++y) CheckedRow(in, y).keep(values.row(y), dst.row(y));
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(check_rows);

namespace simd {

void check_winners(Pool& pool, const CheckLeftRight& in, View<std::int16_t> dst) {
  DUO_CHECK(in.left.size() == in.right.size() && in.left.size() == dst.size());
  const auto check = HWY_DYNAMIC_DISPATCH(check_rows);
  pool.rows(dst.height(), [&](int begin, int end) { check(in, in.left, dst, begin, end); });
}

void check_left_right(Pool& pool, const CheckLeftRight& in, View<const std::uint16_t> fine, View<std::uint16_t> dst) {
  DUO_CHECK(in.left.size() == in.right.size() && in.left.size() == dst.size() && in.left.size() == fine.size());
  static_assert(static_cast<std::int16_t>(Disparity::kNone) == -1);
  const View<const std::int16_t> values(reinterpret_cast<const std::int16_t*>(fine.data()), fine.size(), fine.stride());
  const View<std::int16_t> out(reinterpret_cast<std::int16_t*>(dst.data()), dst.size(), dst.stride());
  const auto check = HWY_DYNAMIC_DISPATCH(check_rows);
  pool.rows(dst.height(), [&](int begin, int end) { check(in, values, out, begin, end); });
}

}  // namespace simd
}  // namespace duo
#endif
