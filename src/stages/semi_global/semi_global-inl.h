// The vectors of semi_global: least lane, one step of a path, cost of a pixel. Included once for each instruction set.

#include <cstdlib>

#include "stages/semi_global/semi_global.h"

#if defined(DUO_SEMI_GLOBAL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DUO_SEMI_GLOBAL_INL_H
#undef DUO_SEMI_GLOBAL_INL_H
#else
#define DUO_SEMI_GLOBAL_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
// A quarter faster than 32 bytes on Intel's cores; on AMD's Zen 5 the same.
using D = hn::CappedTag<std::uint8_t, 64>;
using V = hn::Vec<D>;
using Scratch = simd::SemiGlobalScratch;

constexpr int kGap = Scratch::kGap;

HWY_INLINE V set(int value) { return hn::Set(D(), static_cast<std::uint8_t>(value)); }

/// The least of all lanes of two vectors: the first one's in the low byte, the second one's in the next.
template <class DV>
HWY_INLINE int least(DV d, hn::Vec<DV> a, hn::Vec<DV> b) {
  if constexpr (hn::MaxLanes(DV()) > 16) {
    const hn::Half<DV> half;
    return least(half, hn::Min(hn::LowerHalf(half, a), hn::UpperHalf(half, a)),
                 hn::Min(hn::LowerHalf(half, b), hn::UpperHalf(half, b)));
  } else {
    const hn::Repartition<std::uint16_t, DV> d16;
    auto v = hn::Min(hn::InterleaveLower(d, a, b), hn::InterleaveUpper(d, a, b));
    v = hn::Min(v, hn::ShiftRightBytes<8>(d, v));
    v = hn::Min(v, hn::ShiftRightBytes<4>(d, v));
    v = hn::Min(v, hn::ShiftRightBytes<2>(d, v));
    return hn::GetLane(hn::BitCast(d16, v));
  }
}
/// The least of every fourth lane: four bytes.
template <class DV>
HWY_INLINE std::uint32_t least_fourth(DV d, hn::Vec<DV> v) {
  if constexpr (hn::MaxLanes(DV()) > 16) {
    const hn::Half<DV> half;
    return least_fourth(half, hn::Min(hn::LowerHalf(half, v), hn::UpperHalf(half, v)));
  } else {
    const hn::Repartition<std::uint32_t, DV> d32;
    v = hn::Min(v, hn::ShiftRightBytes<8>(d, v));
    v = hn::Min(v, hn::ShiftRightBytes<4>(d, v));
    return hn::GetLane(hn::BitCast(d32, v));
  }
}
/// The same of four vectors, in four bytes: half the work of two pairs.
template <class DV>
HWY_INLINE std::uint32_t least(DV d, hn::Vec<DV> a, hn::Vec<DV> b, hn::Vec<DV> c, hn::Vec<DV> e) {
  const hn::Repartition<std::uint16_t, DV> d16;
  const auto ab = hn::BitCast(d16, hn::Min(hn::InterleaveLower(d, a, b), hn::InterleaveUpper(d, a, b)));
  const auto ce = hn::BitCast(d16, hn::Min(hn::InterleaveLower(d, c, e), hn::InterleaveUpper(d, c, e)));
  const auto lower = hn::BitCast(d, hn::InterleaveLower(d16, ab, ce)), upper = hn::BitCast(d, hn::InterleaveUpper(d16, ab, ce));
  return least_fourth(d, hn::Min(lower, upper));
}
HWY_INLINE int first_of(int pair) { return pair & 255; }
HWY_INLINE int second_of(int pair) { return pair >> 8; }

/// What the pixel before on a path left behind. Least and P2 are bytes in memory: from there they are broadcast in one step.
struct Before {
  const std::uint8_t* costs;  // lane 0 of its path costs
  V least, beside_most, p1;
  /// `p2_more`: P2 - P1.
  Before(const std::uint8_t* costs_, const std::uint8_t* least_, const std::uint8_t* p2_more, int p1_)
      : costs(costs_), least(hn::Set(D(), *least_)), beside_most(hn::Add(least, hn::Set(D(), *p2_more))), p1(set(p1_)) {}

  /// A neighbour beyond min L' + P2 - P1 is no better than a larger step: held to that, it becomes one when P1 is added. So
  /// nothing passes 255, and what is added need not saturate, which only half the units can do; but for lanes that hold no
  /// disparity, whose cost is 255.
  template <bool kUnused>
  HWY_INLINE V step(int j, V cost) const {
    const D d;
    const auto beside = hn::Min(hn::Min(hn::LoadU(d, costs + j - 1), hn::LoadU(d, costs + j + 1)), beside_most);
    const auto best = hn::Min(hn::Load(d, costs + j), hn::Add(beside, p1));
    return kUnused ? hn::SaturatedAdd(cost, hn::Sub(best, least)) : hn::Add(cost, hn::Sub(best, least));
  }
};

/// The planes of one row: values of the left view, and where those of the right view's lane 0 are for x = 0. Held by value, as
/// everything that is only pointed to would be read again after each byte stored.
struct RowPlanes {
  const std::uint8_t *census[2], *value[3], *low[3], *high[3], *outside;
  RowPlanes(const MatchPlanes& planes, int y, int offset) {
    for (std::size_t i = 0; i < 2; ++i) census[i] = planes.census[i].row(y) + offset;
    for (std::size_t c = 0; c < 3; ++c) {
      value[c] = planes.value[c].row(y) + offset;
      low[c] = planes.low[c].row(y) + offset;
      high[c] = planes.high[c].row(y) + offset;
    }
    outside = planes.outside.row(y) + offset;
  }
};

/// One pixel's side of the cost, broadcast.
struct PixelCost {
  const RowPlanes& right;
  int x;
  V census[2], value[3], low[3], high[3], census_most, most, outside;

  HWY_INLINE PixelCost(const RowPlanes& left, const RowPlanes& right_, const SemiGlobalParams& params, int x_)
      : right(right_), x(x_) {
    for (std::size_t i = 0; i < 2; ++i) census[i] = set(left.census[i][x]);
    for (std::size_t c = 0; c < 3; ++c) {
      value[c] = set(left.value[c][x]);
      low[c] = set(left.low[c][x]);
      high[c] = set(left.high[c][x]);
    }
    census_most = set(params.census_truncation);
    most = set(params.truncation);
    outside = set(left.outside[x]);
  }

  HWY_INLINE V at(int j) const {
    const D d;
    const auto load = [&](const std::uint8_t* plane) HWY_ATTR { return hn::LoadU(d, plane + x + j); };
    auto sum = hn::Min(hn::Add(hn::PopulationCount(hn::Xor(census[0], load(right.census[0]))),
                               hn::PopulationCount(hn::Xor(census[1], load(right.census[1])))),
                       census_most);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto v = load(right.value[c]);
      const auto to_right =
          hn::Or(hn::SaturatedSub(value[c], load(right.high[c])), hn::SaturatedSub(load(right.low[c]), value[c]));
      const auto to_left = hn::Or(hn::SaturatedSub(v, high[c]), hn::SaturatedSub(low[c], v));
      sum = hn::Add(sum, hn::Min(hn::Min(to_right, to_left), most));
    }
    const auto all = hn::Add(census_most, hn::Add(most, hn::Add(most, most)));
    return hn::IfVecThenElse(hn::Or(outside, load(right.outside)), all, sum);
  }
};

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
