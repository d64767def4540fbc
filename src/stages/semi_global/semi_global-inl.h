// The vectors of semi_global: least lane, one step of a path. Included once for each instruction set.

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

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
