// Lanes are taps of a row, which are two columns apart. Sums over the window's rows are kept for each column of taps: the row
// that comes in is added, the one that goes out taken off. Of the right view the four bytes that a tap needs come with one
// gather.

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
/// Of each gradient pull | inverse << 16.
constexpr auto kPullAndInverse = [] {
  std::array<std::int32_t, LucasKanade::kMostGradient_q2 + 1> out{};
  for (int g = 0; g <= LucasKanade::kMostGradient_q2; ++g)
    out[static_cast<std::size_t>(g)] = lucas_kanade_pull(g) | lucas_kanade_inverse(g) << 16;
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
  static constexpr int kReach = LucasKanade::kReach, kRows = simd::LucasKanadeScratch::kRows,
                       kBefore = simd::LucasKanadeScratch::kBefore;

 public:
  Gradients(const LucasKanade& in, Thread& thread, View<std::uint16_t> dst)
      : in_(in), t_(thread), dst_(dst), w_(dst.width()), h_(dst.height()), blocks_((w_ + 1) / 2), block_rows_((h_ + 1) / 2) {}

  void rows(int begin, int end) {
    for (const int k : {kPull, kWeight})
      std::memset(t_.sums.row(k), 0, sizeof(std::int32_t) * static_cast<std::size_t>(t_.sums.width()));
    // The last picture may have been wider.
    for (Image<std::int32_t>* taps : {&t_.pull, &t_.weight})
      for (int k = 0; k < kRows; ++k) std::fill_n(taps->row(k), taps->width(), 0);
    const int first = begin / 2;
    for (int y = std::max(first - kReach, 0); y < std::min(first + kReach, block_rows_); ++y) tap_row(y), add_row<1>(y);
    for (int y = first; 2 * y < end; ++y) {
      if (y + kReach < block_rows_) tap_row(y + kReach), add_row<1>(y + kReach);
      step_row();
      for (int row = std::max(2 * y, begin); row < std::min(2 * y + 2, end); ++row) move_row(row);
      if (y >= kReach) add_row<-1>(y - kReach);
    }
  }

 private:
  enum { kPull, kWeight, kPullOfThree, kWeightOfThree };  // rows of sums

  static int turn(int y) { return y % kRows; }

  // Of row y of blocks. A tap and its neighbours are in the picture.
  void tap_row(int y) {
    if (w_ < 4) return;  // no tap has all its neighbours, nor a gather its four bytes: all stay 0
    const hn::CappedTag<std::int32_t, 1> one;
    const D many;
    const int n = static_cast<int>(hn::Lanes(many)), last = (w_ - 2) / 2;  // 2 last + 1 < w
    int i = 1;
    for (; i + n <= last + 1; i += n) tap(many, y, i);
    if (i > 1 && i <= last)
      tap(many, y, last + 1 - n);  // some of them once more
    else
      for (; i <= last; ++i) tap(one, y, i);
  }

  template <class D32>
  HWY_INLINE void tap(D32 d, int y, int i) {
    const hn::Rebind<std::uint16_t, D32> du16;
    const hn::Repartition<std::uint16_t, D32> pairs;
    const auto constant = [&](int v) HWY_ATTR { return hn::Set(d, v); };
    const int x = 2 * i, row = 2 * y;
    const auto two = [&](int at) HWY_ATTR {
      return hn::PromoteTo(d, hn::LoadU(du16, reinterpret_cast<const std::uint16_t*>(in_.left.row(row) + at)));
    };
    const auto byte = constant(255);
    const auto from_before = two(x - 1), from_here = two(x);
    const auto left_before = hn::And(from_before, byte), left_here = hn::And(from_here, byte),
               left_after = hn::ShiftRight<8>(from_here);
    const auto disparity = hn::And(hn::BitCast(d, hn::LoadU(pairs, in_.d_q4.row(row) + x)), constant(0xFFFF));
    const auto at_q4 = hn::Sub(hn::ShiftLeft<5>(hn::Iota(d, i)), disparity);
    const auto r = hn::ShiftRight<4>(at_q4), f = hn::And(at_q4, constant(15)), rest = hn::Sub(constant(16), f);
    const auto known = hn::Ne(disparity, constant(std::int32_t{Disparity::kNone}));
    const auto inside = hn::And(known, hn::And(hn::Gt(r, constant(0)), hn::Lt(r, constant(w_ - 2))));
    const auto four = hn::GatherOffset(d, reinterpret_cast<const std::int32_t*>(in_.right.row(row) - 1),
                                       hn::IfThenElse(inside, r, constant(1)));
    const auto before = hn::And(four, byte), here = hn::And(hn::ShiftRight<8>(four), byte),
               after = hn::And(hn::ShiftRight<16>(four), byte), beyond = hn::And(hn::ShiftRight<24>(four), byte);
    const auto e = hn::Sub(hn::ShiftLeft<4>(left_here), hn::Add(hn::Mul(here, rest), hn::Mul(after, f)));
    const auto counts = hn::And(inside, hn::Lt(hn::Abs(e), constant(16 * LucasKanade::kMostDifference)));
    const auto l_q1 = hn::Sub(left_after, left_before);
    const auto r_q5 = hn::Add(hn::Mul(hn::Sub(after, before), rest), hn::Mul(hn::Sub(beyond, here), f));
    const auto g_q2 = hn::ShiftRight<4>(hn::Add(hn::Add(hn::ShiftLeft<4>(l_q1), r_q5), constant(8)));
    const auto both = hn::IfThenElseZero(counts, hn::GatherIndex(d, kPullAndInverse.data(), hn::Abs(g_q2)));
    const auto lr_q4 = hn::ShiftRight<2>(hn::Max(hn::Mul(l_q1, r_q5), hn::Zero(d)));
    const auto weight = hn::Add(hn::ShiftRight<13>(hn::Add(hn::Mul(lr_q4, hn::ShiftRight<16>(both)), constant(1 << 12))),
                                constant(lucas_kanade_weight(0, 0)));
    const auto signed_e = hn::IfThenElse(hn::Lt(g_q2, hn::Zero(d)), hn::Neg(e), e);
    hn::StoreU(hn::Mul(signed_e, hn::And(both, constant(0xFFFF))), d, t_.pull.row(turn(y)) + kBefore + i);
    hn::StoreU(hn::IfThenElseZero(counts, weight), d, t_.weight.row(turn(y)) + kBefore + i);
  }

  template <int kSign>
  void add_row(int y) {
    const D d;
    for (const int k : {kPull, kWeight}) {
      const std::int32_t* const tap = (k == kPull ? t_.pull : t_.weight).row(turn(y)) + kBefore;
      std::int32_t* const sum = t_.sums.row(k) + kBefore;
      for (int i = 0; i < blocks_; i += static_cast<int>(hn::Lanes(d))) {
        const auto old = hn::LoadU(d, sum + i), v = hn::LoadU(d, tap + i);
        hn::StoreU(kSign > 0 ? hn::Add(old, v) : hn::Sub(old, v), d, sum + i);
      }
    }
  }

  void add_three(int from, int to) {
    const D d;
    for (int i = -kReach; i < blocks_ + kReach; i += static_cast<int>(hn::Lanes(d))) {
      const std::int32_t* const at = t_.sums.row(from) + kBefore + i;
      hn::StoreU(hn::Add(hn::Add(hn::LoadU(d, at - 1), hn::LoadU(d, at)), hn::LoadU(d, at + 1)), d,
                 t_.sums.row(to) + kBefore + i);
    }
  }

  // 13 columns are four times three and one.
  void step_row() {
    static_assert(2 * kReach + 1 == 4 * 3 + 1);
    const D d;
    const auto constant = [&](int v) HWY_ATTR { return hn::Set(d, v); };
    add_three(kPull, kPullOfThree);
    add_three(kWeight, kWeightOfThree);
    for (int i = 0; i < blocks_; i += static_cast<int>(hn::Lanes(d))) {
      const auto around = [&](int k, int three) HWY_ATTR {
        auto out = hn::LoadU(d, t_.sums.row(k) + kBefore + i);
        for (const int j : {-5, -2, 2, 5}) out = hn::Add(out, hn::LoadU(d, t_.sums.row(three) + kBefore + i + j));
        return out;
      };
      const auto pull = around(kPull, kPullOfThree), weight = around(kWeight, kWeightOfThree),
                 two = hn::ShiftLeft<1>(hn::Abs(pull)), two_weights = hn::ShiftLeft<1>(weight);
      // One less than what must be reached; without a tap all is 0.
      auto size = hn::Zero(d), below = hn::Sub(hn::Max(weight, constant(1)), constant(1));
      for (int k = 0; k < LucasKanade::kMost_q4; ++k, below = hn::Add(below, two_weights))
        size = hn::Sub(size, hn::VecFromMask(d, hn::Gt(two, below)));
      const auto step = hn::IfThenElse(hn::Gt(pull, hn::Zero(d)), hn::Neg(size), size);
      // Both columns of a block in one lane.
      hn::StoreU(hn::Or(hn::And(step, constant(0xFFFF)), hn::ShiftLeft<16>(step)), d, t_.steps.row(0) + i);
    }
  }

  void move_row(int y) {
    const hn::CappedTag<std::int16_t, 32> many;
    const hn::CappedTag<std::int16_t, 1> one;
    const int n = static_cast<int>(hn::Lanes(many));
    int x = 0;
    for (; x + n <= w_; x += n) move(many, y, x);
    for (; x < w_; ++x) move(one, y, x);
  }

  // A hole is -1; disparities and steps stay below 2^15.
  template <class D16>
  HWY_INLINE void move(D16 d, int y, int x) {
    const auto old = hn::LoadU(d, reinterpret_cast<const std::int16_t*>(in_.d_q4.row(y) + x));
    const auto moved = hn::Add(old, hn::LoadU(d, reinterpret_cast<const std::int16_t*>(t_.steps.row(0)) + x));
    const auto held = hn::Min(hn::Max(moved, hn::Zero(d)), hn::Set(d, static_cast<std::int16_t>(16 * (in_.max_disparity - 1))));
    hn::StoreU(hn::IfThenElse(hn::Lt(old, hn::Zero(d)), old, held), d, reinterpret_cast<std::int16_t*>(dst_.row(y) + x));
  }

  const LucasKanade& in_;
  Thread& t_;
  View<std::uint16_t> dst_;
  int w_, h_, blocks_, block_rows_;
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
  const int padded = kBefore + (size.width + 1) / 2 + kBefore;
  for (int i = 0; i < count; ++i)
    threads.push_back({Image<std::int32_t>({padded, kRows}), Image<std::int32_t>({padded, kRows}),
                       Image<std::int32_t>({padded, 4}), Image<std::int32_t>({padded, 1})});
}

void lucas_kanade(Pool& pool, const LucasKanade& in, LucasKanadeScratch& scratch, View<std::uint16_t> dst) {
  const Size size = in.d_q4.size();
  DUO_CHECK(in.left.size() == size && in.right.size() == size && dst.size() == size && in.max_disparity >= 1);
  DUO_CHECK(static_cast<int>(scratch.threads.size()) >= pool.threads());
  DUO_CHECK(scratch.threads[0].pull.width() >= (size.width + 1) / 2 + 2 * LucasKanadeScratch::kBefore);
  const RowBand rows = in.rows.within(size.height);
  const auto run = HWY_DYNAMIC_DISPATCH(lucas_kanade_rows);
  pool.rows(rows.count(), [&](int begin, int end, int part) {
    run(in, scratch.threads[static_cast<std::size_t>(part)], rows.begin + begin, rows.begin + end, dst);
  });
}

}  // namespace duo::simd
#endif
