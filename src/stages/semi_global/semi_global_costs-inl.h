// Costs of a block of pixels at all disparities. Included once for each instruction set.

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "stages/semi_global/semi_global-inl.h"

#if defined(DUO_SEMI_GLOBAL_COSTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DUO_SEMI_GLOBAL_COSTS_INL_H
#undef DUO_SEMI_GLOBAL_COSTS_INL_H
#else
#define DUO_SEMI_GLOBAL_COSTS_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {

constexpr int kBlock = 32;  // pixels
constexpr int kMostLanes = static_cast<int>(hn::MaxLanes(D()));
// How often the right view's columns are laid out. Vectors of 64 bytes cross a line of the cache however they lie.
constexpr int kTimes = kMostLanes > kBlock ? 1 : 2;

// Where bits are counted by a table of nibbles anyway, the left pixel's nibble chooses the table: one look-up counts what
// differs. (Not measured with the AVX-512 that has no bit counts.)
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_SSSE3
constexpr bool kByNibbles = true;
#else
constexpr bool kByNibbles = false;
#endif
constexpr std::size_t kCensusRows = kByNibbles ? 4 : 2;

/// [left nibble][right nibble]: bits that differ.
struct DifferingBits {
  HWY_ALIGN_MAX std::uint8_t of[16][16];
  constexpr DifferingBits() : of() {
    for (unsigned i = 0; i < 16; ++i)
      for (unsigned k = 0; k < 16; ++k)
        of[i][k] = static_cast<std::uint8_t>((i ^ k) % 2 + (i ^ k) / 2 % 2 + (i ^ k) / 4 % 2 + (i ^ k) / 8);
  }
};
inline constexpr DifferingBits kDiffering;

/// What a row's pixels cost, block by block. What both views bring to it is laid out anew for each block, at constant distances
/// that need no register. Where vectors have 32 bytes, each 32 columns of the right view are followed by the next 32, which are
/// there twice: so all vectors of a block's first pixel begin at a line of the cache, and no pixel's cross one.
///
/// A channel's cost of left value a within [a - a0, a + a1] and right value b within [b - b0, b + b1]: of the distances of each
/// value to the other's interval, the smaller one, is a - b - max(a0, b1) where a > b, and b - a - max(a1, b0) where a < b, and
/// at least 0, as an interval holds its own value.
class RowCosts {
 public:
  /// Of row y; lane 0 holds disparity lanes - 1, and those before lane lanes - max_disparity none.
  RowCosts(const SemiGlobal& in, int y, int lanes)
      : in_(in), y_(y), lanes_(lanes), empty_(lanes - in.max_disparity), first_(empty_ / kTogether * kTogether) {}

  /// Of columns [begin, end), a block at most. `costs` [column][lane].
  HWY_NOINLINE void block(int begin, int end, std::uint8_t* costs) {
    const bool left = lay_out(in_.left, begin, 0, end - begin, left_);
    const bool right = lay_out(in_.right, begin + 1 - lanes_, first_, lanes_ + end - begin, right_);
    costs += static_cast<std::ptrdiff_t>(begin) * lanes_;
    left || right ? pixels<true>(end - begin, costs) : pixels<false>(end - begin, costs);
  }

 private:
  static constexpr int kTogether = std::max(kBlock, kMostLanes);  // columns
  template <int kColumns, int kTheTimes>
  struct Rows {
    static constexpr int kBytes = kColumns * kTheTimes;
    HWY_ALIGN_MAX std::uint8_t census[kCensusRows][kBytes];
    HWY_ALIGN_MAX std::uint8_t value[3][kBytes], below[3][kBytes], above[3][kBytes], outside[kBytes];
  };
  static int n() { return static_cast<int>(hn::Lanes(D())); }

  /// Columns from + [begin, end) of a view, `begin` a multiple of kTogether; whether some pixel of them or beside them is
  /// outside.
  template <int kColumns, int kTheTimes>
  HWY_INLINE bool lay_out(const MatchPlanes& planes, int from, int begin, int end, Rows<kColumns, kTheTimes>& out) const {
    const D d;
    auto some = hn::Zero(d);
    const auto row = [&](View<const std::uint8_t> plane) { return plane.row(y_) + from; };
    const std::uint8_t *const census[] = {row(planes.census[0]), row(planes.census[1])}, *const outside = row(planes.outside);
    const std::uint8_t *value[3], *low[3], *high[3];
    for (std::size_t c = 0; c < 3; ++c)
      value[c] = row(planes.value[c]), low[c] = row(planes.low[c]), high[c] = row(planes.high[c]);
    for (int x = begin; x < end; x += n()) {
      const auto keep = [&](V v, std::uint8_t* row) HWY_ATTR {
        row += kTheTimes == 2 ? x / kBlock * kBlock + x : x;
        hn::Store(v, d, row);
        if (kTheTimes == 2 && x >= kBlock) hn::Store(v, d, row - kBlock);
      };
      for (std::size_t i = 0; i < 2; ++i) {
        const auto bits = hn::LoadU(d, census[i] + x);
        if constexpr (kByNibbles) {
          keep(hn::And(bits, set(15)), out.census[2 * i]);
          keep(hn::ShiftRight<4>(bits), out.census[2 * i + 1]);
        } else {
          keep(bits, out.census[i]);
        }
      }
      for (std::size_t c = 0; c < 3; ++c) {
        const auto v = hn::LoadU(d, value[c] + x);
        keep(v, out.value[c]);
        keep(hn::Sub(v, hn::LoadU(d, low[c] + x)), out.below[c]);
        keep(hn::Sub(hn::LoadU(d, high[c] + x), v), out.above[c]);
      }
      const auto marks = hn::LoadU(d, outside + x);
      keep(marks, out.outside);
      some = hn::Or(some, marks);
    }
    return !hn::AllTrue(d, hn::Eq(some, hn::Zero(d)));
  }

  /// Calls f(lane, bytes from a row of right_ to what is compared there with the block's first pixel).
  template <class F>
  static HWY_INLINE void each_vector(int first, int lanes, const F& f) {
    for (int j = first; j < lanes; j += kTogether)
      for (int k = 0; k < kTogether; k += n()) f(j + k, kTimes * j + k);
  }

  /// What is compared with a left pixel's value in one channel.
  struct Channel {
    const std::uint8_t *right_value, *right_below, *right_above;
    V value, below, above;
    HWY_INLINE V cost(int at, V most) const {
      const D d;
      const auto v = hn::LoadU(d, right_value + at);
      const auto darker = hn::SaturatedSub(hn::SaturatedSub(value, v), hn::Max(below, hn::LoadU(d, right_above + at)));
      const auto brighter = hn::SaturatedSub(hn::SaturatedSub(v, value), hn::Max(above, hn::LoadU(d, right_below + at)));
      return hn::Min(hn::Or(darker, brighter), most);
    }
  };

  template <bool kOutside>
  HWY_INLINE void pixels(int count, std::uint8_t* costs) {
    const D d;
    const auto census_most = set(in_.params.census_truncation), most = set(in_.params.truncation);
    const int lanes = lanes_, first = first_, empty = empty_, begin = empty_ / kGap * kGap;
    for (int i = 0; i < count; ++i, costs += lanes) {
      const auto channel = [&](std::size_t c) HWY_ATTR {
        return Channel{right_.value[c] + i,    right_.below[c] + i,    right_.above[c] + i,
                       set(left_.value[c][i]), set(left_.below[c][i]), set(left_.above[c][i])};
      };
      // In two turns, as all that is compared with does not fit sixteen registers.
      {
        V census[kCensusRows];
        for (std::size_t k = 0; k < kCensusRows; ++k)
          census[k] = kByNibbles ? hn::LoadDup128(d, kDiffering.of[left_.census[k][i]]) : set(left_.census[k][i]);
        const auto differing = [&](std::size_t k, int at) HWY_ATTR {
          const auto right = hn::LoadU(d, right_.census[k] + i + at);
          return kByNibbles ? hn::TableLookupBytes(census[k], right) : hn::PopulationCount(hn::Xor(census[k], right));
        };
        const Channel gray = channel(0);
        each_vector(first, lanes, [&](int j, int at) HWY_ATTR {
          auto cost = hn::Add(differing(0, at), differing(1, at));
          if constexpr (kByNibbles) cost = hn::Add(cost, hn::Add(differing(2, at), differing(3, at)));
          hn::Store(hn::Add(hn::Min(cost, census_most), gray.cost(at, most)), d, costs + j);
        });
      }
      const Channel along = channel(1), down = channel(2);
      const auto all = hn::Add(census_most, hn::Add(most, hn::Add(most, most))), outside = set(left_.outside[i]);
      each_vector(first, lanes, [&](int j, int at) HWY_ATTR {
        auto cost = hn::Add(hn::Load(d, costs + j), hn::Add(along.cost(at, most), down.cost(at, most)));
        if (kOutside) cost = hn::IfVecThenElse(hn::Or(outside, hn::LoadU(d, right_.outside + i + at)), all, cost);
        hn::Store(cost, d, costs + j);
      });
      if (begin < empty) std::memset(costs + begin, 255, static_cast<std::size_t>(empty - begin));
    }
  }

  const SemiGlobal& in_;
  const int y_, lanes_, empty_, first_;
  Rows<kTogether, 1> left_;
  Rows<256 + kTogether, kTimes> right_;
};

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
