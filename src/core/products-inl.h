// The inner step of layers in 16-bit integers. Included once for each instruction set.

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "core/tensor.h"

#if defined(DUO_PRODUCTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DUO_PRODUCTS_INL_H
#undef DUO_PRODUCTS_INL_H
#else
#define DUO_PRODUCTS_INL_H
#endif

// Highway 1.0.3 asks a processor of this target for VNNI, but does not use it.
#undef DUO_BEFORE_PRODUCTS
#if HWY_TARGET == HWY_AVX3_DL
#define DUO_BEFORE_PRODUCTS() HWY_PUSH_ATTRIBUTES(HWY_TARGET_STR ",avx512vnni")
#else
#define DUO_BEFORE_PRODUCTS() HWY_BEFORE_NAMESPACE()
#endif

DUO_BEFORE_PRODUCTS();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Sums of products of 16 bits in the lanes of D, 32 bits, which wrap. On some processors the products of even and of odd
/// places are summed apart.
template <class D>
class Products {
 public:
  using V = hn::Vec<D>;

  HWY_INLINE Products() : even_(hn::Zero(D())), odd_(hn::Zero(D())) {}

  /// Adds to each lane the products of its two halves: a.low * b.low + a.high * b.high.
  HWY_INLINE void add(V a, V b) {
    const hn::Repartition<std::int16_t, D> d16;
#if HWY_TARGET == HWY_AVX3_DL
    if constexpr (hn::MaxLanes(D()) == 16)
      even_ = V{_mm512_dpwssd_epi32(even_.raw, a.raw, b.raw)};
    else
#endif
      even_ = hn::ReorderWidenMulAccumulate(D(), hn::BitCast(d16, a), hn::BitCast(d16, b), even_, odd_);
      // Inside a loop g++ 12 would keep a sum twice, as vectors of two types, and run out of registers.
#if HWY_ARCH_X86 && HWY_TARGET != HWY_EMU128
    auto raw = even_.raw;
    asm("" : "+v"(raw));
    even_ = V{raw};
#endif
  }

  HWY_INLINE V sum() const { return hn::RearrangeToOddPlusEven(even_, odd_); }

 private:
  V even_, odd_;
};

/// Two values side by side, in each lane.
template <class D>
HWY_INLINE hn::Vec<D> pair_at(D d, const std::int16_t* at) {
  std::int32_t both;
  std::memcpy(&both, at, sizeof both);
  return hn::Set(d, both);
}

/// Values of `a`, then of `b`, as 16 bits; what lies outside becomes the nearest that does not.
template <class D16, class V>
HWY_INLINE hn::Vec<D16> demote_both(D16 d16, V a, V b) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_EMU128
  const auto mixed = hn::ReorderDemote2To(d16, a, b);
  if constexpr (hn::MaxLanes(d16) == 8) return mixed;
  // Fours of a and b alternate.
  const hn::Repartition<std::uint64_t, D16> d64;
  alignas(64) static constexpr std::uint64_t kOrder[] = {0, 2, 4, 6, 1, 3, 5, 7}, kOrder4[] = {0, 2, 1, 3};
  const auto order = hn::SetTableIndices(d64, hn::MaxLanes(d64) == 8 ? kOrder : kOrder4);
  return hn::BitCast(d16, hn::TableLookupLanes(hn::BitCast(d64, mixed), order));
#else
  const hn::Half<D16> half;
  return hn::Combine(d16, hn::DemoteTo(half, b), hn::DemoteTo(half, a));
#endif
}

/// Stores the first `count` of the outputs range.clamp((sum + bias) >> shift), which vectors of D hold side by side.
template <class D, int kVectors>
HWY_INLINE void store_outputs(D, const hn::Vec<D> (&sum)[kVectors], const hn::Vec<D> (&bias)[kVectors],
                              const hn::Vec<D> (&shift)[kVectors], Range16 range, std::int16_t* out, int count) {
  constexpr int kCount = kVectors * static_cast<int>(hn::MaxLanes(D()));
  const hn::CappedTag<std::int16_t, kCount> d16;
  // Demotion saturates, which the range makes good.
  hn::Vec<decltype(d16)> values;
  const auto first = hn::Shr(hn::Add(sum[0], bias[0]), shift[0]);
  if constexpr (kVectors == 2)
    values = demote_both(d16, first, hn::Shr(hn::Add(sum[1], bias[1]), shift[1]));
  else
    values = hn::DemoteTo(d16, first);
  values = hn::Clamp(values, hn::Set(d16, range.low), hn::Set(d16, range.high));
  if (count >= kCount) {
    hn::StoreU(values, d16, out);
  } else {
    HWY_ALIGN std::int16_t last[kCount];
    hn::Store(values, d16, last);
    std::copy_n(last, count, out);
  }
}

/// Calls vector(d, i) for as many vectors of `count` values as there are, first wide ones, then those of 8, and plain(i) for
/// the values that are left.
template <class D, class Vector, class Plain>
HWY_INLINE void each_vector(D d, int count, Vector vector, Plain plain, int i = 0) {
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));
  for (; i + kLanes <= count; i += kLanes) vector(d, i);
  if constexpr (kLanes > 8)
    each_vector(hn::Half<D>(), count, vector, plain, i);
  else
    for (; i < count; ++i) plain(i);
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
