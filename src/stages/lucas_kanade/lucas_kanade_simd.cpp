// Lanes are columns of a pair of rows: odd ones look at its second row. Sums over the window's pairs are kept for each column:
// the pair that comes in is added, the one that goes out taken off. Of the right view the four bytes that a tap needs come with
// one gather.

#include <algorithm>
#include <array>
#include <cstring>

#include "core/check.h"
#include "stages/lucas_kanade/lucas_kanade.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/lucas_kanade/lucas_kanade_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

#ifndef DUO_LUCAS_KANADE_ONCE
#define DUO_LUCAS_KANADE_ONCE
namespace duo {
/// Of each gradient pull | weight << 16.
constexpr auto kPullAndWeight = [] {
  std::array<std::int32_t, LucasKanade::kMostGradient_q2 + 1> out{};
  for (int g = 0; g <= LucasKanade::kMostGradient_q2; ++g)
    out[static_cast<std::size_t>(g)] = lucas_kanade_pull(g) | lucas_kanade_weight(g) << 16;
  return out;
}();
}  // namespace duo
#endif

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

class Gradients {
  using Thread = simd::LucasKanadeScratch::Thread;
  using D = hn::CappedTag<std::int32_t, 16>;
  static constexpr int kRadius = LucasKanade::kRadius, kRows = simd::LucasKanadeScratch::kRows,
                       kBefore = simd::LucasKanadeScratch::kBefore;

 public:
  Gradients(const LucasKanade& in, Thread& thread, View<std::uint16_t> dst)
      : in_(in), t_(thread), dst_(dst), w_(dst.width()), h_(dst.height()) {}

  void rows(int begin, int end) {
    for (const int k : {kPull, kWeight})
      std::memset(t_.sums.row(k), 0, sizeof(std::int32_t) * static_cast<std::size_t>(t_.sums.width()));
    // The last picture may have been wider; without taps, see tap_row(), all columns are of it.
    const int last = w_ < 4 ? 0 : w_ - 1;
    for (Image<std::int16_t>* taps : {&t_.pull, &t_.weight})
      for (int k = 0; k < kRows; ++k) std::fill_n(taps->row(k) + kBefore + last, w_ - last + kBefore, std::int16_t{0});
    const int first = begin / 2 * 2;
    for (int y = std::max(first - kRadius, 0); y < std::min(first + kRadius, h_); y += 2) tap_row(y), add_row<1>(y);
    for (int pair = first; pair < end; pair += 2) {
      if (pair + kRadius < h_) tap_row(pair + kRadius), add_row<1>(pair + kRadius);
      step_row();
      for (int y = std::max(pair, begin); y < std::min(pair + 2, end); ++y) move_row(y);
      if (pair >= kRadius) add_row<-1>(pair - kRadius);
    }
  }

 private:
  enum { kPull, kWeight, kPullOfFive, kWeightOfFive, kSteps };  // rows of sums

  static int turn(int y) { return y / 2 % kRows; }

  void tap_row(int y) {
    if (w_ < 4) return;  // no tap has all its neighbours, nor a gather its four bytes: all stay 0
    const hn::CappedTag<std::int32_t, 1> one;
    const D many;
    const int n = static_cast<int>(hn::Lanes(many));
    int x = 1;
    for (; x + n < w_; x += n) tap(many, y, x);
    if (x > 1 && x + 1 < w_)
      tap(many, y, w_ - 1 - n);  // some of them once more
    else
      for (; x + 1 < w_; ++x) tap(one, y, x);
  }

  template <class D32>
  HWY_INLINE void tap(D32 d, int y, int x) {
    const hn::Rebind<std::uint8_t, D32> d8;
    const hn::Rebind<std::uint16_t, D32> du16;
    const hn::Rebind<std::int16_t, D32> d16;
    const auto constant = [&](int v) HWY_ATTR { return hn::Set(d, v); };
    const int second = std::min(y + 1, h_ - 1);  // what it reads in its own place does not count, see below
    const auto column = hn::Iota(d, x);
    const auto odd = hn::Ne(hn::And(column, constant(1)), hn::Zero(d));
    const auto left = [&](int at) HWY_ATTR {
      return hn::IfThenElse(odd, hn::PromoteTo(d, hn::LoadU(d8, in_.left.row(second) + at)),
                            hn::PromoteTo(d, hn::LoadU(d8, in_.left.row(y) + at)));
    };
    const auto disparity = hn::IfThenElse(odd, hn::PromoteTo(d, hn::LoadU(du16, in_.d_q4.row(second) + x)),
                                          hn::PromoteTo(d, hn::LoadU(du16, in_.d_q4.row(y) + x)));
    const auto at_q4 = hn::Sub(hn::ShiftLeft<4>(column), disparity);
    const auto r = hn::ShiftRight<4>(at_q4), f = hn::And(at_q4, constant(15)), rest = hn::Sub(constant(16), f);
    const auto known = hn::Ne(disparity, constant(std::int32_t{Disparity::kNone}));
    const auto there = hn::Or(hn::Not(odd), hn::Gt(constant(h_), constant(y + 1)));
    const auto inside = hn::And(hn::And(known, there), hn::And(hn::Gt(r, constant(0)), hn::Lt(r, constant(w_ - 2))));
    const auto row = hn::IfThenElseZero(odd, constant(static_cast<int>(in_.right.row(second) - in_.right.row(y))));
    const auto four = hn::GatherOffset(d, reinterpret_cast<const std::int32_t*>(in_.right.row(y) - 1),
                                       hn::IfThenElse(inside, hn::Add(row, r), constant(1)));
    const auto byte = constant(255);
    const auto before = hn::And(four, byte), here = hn::And(hn::ShiftRight<8>(four), byte),
               after = hn::And(hn::ShiftRight<16>(four), byte), beyond = hn::And(hn::ShiftRight<24>(four), byte);
    const auto e = hn::Sub(hn::ShiftLeft<4>(left(x)), hn::Add(hn::Mul(here, rest), hn::Mul(after, f)));
    const auto counts = hn::And(inside, hn::Lt(hn::Abs(e), constant(16 * LucasKanade::kMostDifference)));
    const auto slope_q6 = hn::Add(hn::ShiftLeft<4>(hn::Sub(left(x + 1), left(x - 1))),
                                  hn::Add(hn::Mul(hn::Sub(after, before), rest), hn::Mul(hn::Sub(beyond, here), f)));
    const auto g_q2 = hn::ShiftRight<4>(hn::Add(slope_q6, constant(8)));
    const auto both = hn::IfThenElseZero(counts, hn::GatherIndex(d, kPullAndWeight.data(), hn::Abs(g_q2)));
    const auto signed_e = hn::IfThenElse(hn::Lt(g_q2, hn::Zero(d)), hn::Neg(e), e);
    const auto pull = hn::Mul(signed_e, hn::And(both, constant(0xFFFF)));
    hn::StoreU(hn::DemoteTo(d16, pull), d16, t_.pull.row(turn(y)) + kBefore + x);
    hn::StoreU(hn::DemoteTo(d16, hn::ShiftRight<16>(both)), d16, t_.weight.row(turn(y)) + kBefore + x);
  }

  template <int kSign>
  void add_row(int y) {
    const D d;
    const hn::Rebind<std::int16_t, D> d16;
    for (const int k : {kPull, kWeight}) {
      const std::int16_t* const tap = (k == kPull ? t_.pull : t_.weight).row(turn(y)) + kBefore;
      std::int32_t* const sum = t_.sums.row(k) + kBefore;
      for (int x = 0; x < w_; x += static_cast<int>(hn::Lanes(d))) {
        const auto old = hn::LoadU(d, sum + x), v = hn::PromoteTo(d, hn::LoadU(d16, tap + x));
        hn::StoreU(kSign > 0 ? hn::Add(old, v) : hn::Sub(old, v), d, sum + x);
      }
    }
  }

  // 25 columns are five times five.
  void add_five(int from, int to) {
    const D d;
    for (int x = -kBefore / 2; x < w_ + kRadius; x += static_cast<int>(hn::Lanes(d))) {
      const std::int32_t* const at = t_.sums.row(from) + kBefore + x;
      const auto outer = hn::Add(hn::LoadU(d, at - 2), hn::LoadU(d, at + 2)),
                 inner = hn::Add(hn::LoadU(d, at - 1), hn::LoadU(d, at + 1));
      hn::StoreU(hn::Add(hn::Add(outer, inner), hn::LoadU(d, at)), d, t_.sums.row(to) + kBefore + x);
    }
  }

  void step_row() {
    static_assert(2 * kRadius + 1 == 5 * 5);
    const D d;
    const auto constant = [&](int v) HWY_ATTR { return hn::Set(d, v); };
    add_five(kPull, kPullOfFive);
    add_five(kWeight, kWeightOfFive);
    for (int x = 0; x < w_; x += static_cast<int>(hn::Lanes(d))) {
      const auto around = [&](int k) HWY_ATTR {
        const std::int32_t* const at = t_.sums.row(k) + kBefore + x;
        auto out = hn::LoadU(d, at);
        for (const int i : {-10, -5, 5, 10}) out = hn::Add(out, hn::LoadU(d, at + i));
        return out;
      };
      const auto pull = around(kPullOfFive), weight = around(kWeightOfFive), two = hn::ShiftLeft<1>(hn::Abs(pull)),
                 two_weights = hn::ShiftLeft<1>(weight);
      // One less than what must be reached; without a tap all is 0.
      auto size = hn::Zero(d), below = hn::Sub(hn::Max(weight, constant(1)), constant(1));
      for (int k = 0; k < LucasKanade::kMost_q4; ++k, below = hn::Add(below, two_weights))
        size = hn::Sub(size, hn::VecFromMask(d, hn::Gt(two, below)));
      hn::StoreU(hn::IfThenElse(hn::Gt(pull, hn::Zero(d)), hn::Neg(size), size), d, t_.sums.row(kSteps) + x);
    }
  }

  void move_row(int y) {
    const D many;
    const hn::CappedTag<std::int32_t, 1> one;
    const int n = static_cast<int>(hn::Lanes(many));
    int x = 0;
    for (; x + n <= w_; x += n) move(many, y, x);
    for (; x < w_; ++x) move(one, y, x);
  }

  template <class D32>
  HWY_INLINE void move(D32 d, int y, int x) {
    const hn::Rebind<std::uint16_t, D32> d16;
    const auto old = hn::PromoteTo(d, hn::LoadU(d16, in_.d_q4.row(y) + x));
    const auto moved = hn::Add(old, hn::LoadU(d, t_.sums.row(kSteps) + x));
    const auto held = hn::Min(hn::Max(moved, hn::Zero(d)), hn::Set(d, 16 * (in_.max_disparity - 1)));
    const auto hole = hn::Eq(old, hn::Set(d, std::int32_t{Disparity::kNone}));
    hn::StoreU(hn::DemoteTo(d16, hn::IfThenElse(hole, old, held)), d16, dst_.row(y) + x);
  }

  const LucasKanade& in_;
  Thread& t_;
  View<std::uint16_t> dst_;
  int w_, h_;
};

void lucas_kanade_rows(const LucasKanade& in, simd::LucasKanadeScratch::Thread& thread, int begin, int end,
                       View<std::uint16_t> dst) {
  Gradients(in, thread, dst).rows(begin, end);
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo::simd {
HWY_EXPORT(lucas_kanade_rows);

LucasKanadeScratch::LucasKanadeScratch(Size size, int count) {
  const int padded = kBefore + size.width + kBefore;
  for (int i = 0; i < count; ++i)
    threads.push_back(
        {Image<std::int16_t>({padded, kRows}), Image<std::int16_t>({padded, kRows}), Image<std::int32_t>({padded, 5})});
}

void lucas_kanade(Pool& pool, const LucasKanade& in, LucasKanadeScratch& scratch, View<std::uint16_t> dst) {
  const Size size = in.d_q4.size();
  DUO_CHECK(in.left.size() == size && in.right.size() == size && dst.size() == size && in.max_disparity >= 1);
  DUO_CHECK(static_cast<int>(scratch.threads.size()) >= pool.threads());
  DUO_CHECK(scratch.threads[0].pull.width() >= size.width + 2 * LucasKanadeScratch::kBefore);
  const RowBand rows = in.rows.within(size.height);
  const auto run = HWY_DYNAMIC_DISPATCH(lucas_kanade_rows);
  pool.rows(rows.count(), [&](int begin, int end, int part) {
    run(in, scratch.threads[static_cast<std::size_t>(part)], rows.begin + begin, rows.begin + end, dst);
  });
}

}  // namespace duo::simd
#endif
