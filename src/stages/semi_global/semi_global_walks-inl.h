// A row's walk from left to right and its way back. Included once for each instruction set.

#include <bit>
#include <cstring>
#include <type_traits>

#include "stages/semi_global/semi_global-inl.h"

#if defined(DUO_SEMI_GLOBAL_WALKS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DUO_SEMI_GLOBAL_WALKS_INL_H
#undef DUO_SEMI_GLOBAL_WALKS_INL_H
#else
#define DUO_SEMI_GLOBAL_WALKS_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {

constexpr int kBlock = 32;  // pixels between two looks at the row before
constexpr int kSpins = 20;  // about a microsecond
// The volume comes from main memory, and what fetches ahead by itself stops at each page.
constexpr int kFetchAhead = 16, kLine = 64;  // pixels, bytes

/// What all rows of one sweep share, as one thread sees it. Up: rows are taken from the bottom, and sums go to the volume.
struct Sweep {
  const SemiGlobal& in;
  Scratch& s;
  const SemiGlobalMatch& out;
  int thread, threads;
  bool up;
  int w, h, lanes, first;     // first: lane of the first vector that holds a disparity
  int passed, count;          // rows that paths only pass before those wanted, and rows up to the last wanted
  int ahead;                  // pixels that a row gets ahead of the next one: with all threads at work, half of what it could
  bool partly;                // that first vector has lanes which hold none
  std::uint8_t p2_more[256];  // [gray step]: P2 - P1
  HWY_ALIGN_MAX std::uint8_t disparities[256];  // of the lanes
  HWY_ALIGN_MAX std::uint8_t unused[kGap];      // 255 in the lanes of the first vector which hold none

  Sweep(const SemiGlobal& in_, Scratch& scratch, const SemiGlobalMatch& out_, int thread_, int threads_, bool up_)
      : in(in_),
        s(scratch),
        out(out_),
        thread(thread_),
        threads(threads_),
        up(up_),
        w(in.left.size().width),
        h(in.left.size().height),
        lanes(s.lanes) {
    const int n = static_cast<int>(hn::Lanes(D()));
    first = (lanes - in.max_disparity) / n * n;
    partly = first < lanes - in.max_disparity;
    for (int j = 0; j < lanes; ++j) disparities[j] = static_cast<std::uint8_t>(lanes - 1 - j);
    const RowBand rows = in.rows.within(h);
    passed = up ? h - rows.end : rows.begin;
    count = up ? h - rows.begin : rows.end;
    ahead = std::max(1, w / (2 * threads * kBlock)) * kBlock;
    for (int i = 0; i < 256; ++i) p2_more[i] = static_cast<std::uint8_t>(in.params.p2_at(i) - in.params.p1);
    for (int j = 0; j < kGap; ++j) unused[j] = first + j < lanes - in.max_disparity ? 255 : 0;
  }

  int y_of(int i) const { return up ? h - 1 - i : i; }

  /// Spins a little, then gives the core away. Who caught up lets the row above get ahead, so that not each block ends with
  /// waiting, and is woken in such steps only: a call into the kernel takes longer than a block.
  void wait_for(int i, int pixels) const {
    const std::atomic<int>& done = s.done[static_cast<std::size_t>(i)];
    int now = done.load(std::memory_order_acquire);
    if (now >= pixels) return;
    for (int spins = 0; now < std::min(w, pixels + ahead); now = done.load(std::memory_order_acquire)) {
      hwy::Pause();
      if (++spins > kSpins) done.wait(now, std::memory_order_acquire);
    }
  }
  void finished(int i, int pixels) const {
    std::atomic<int>& done = s.done[static_cast<std::size_t>(i)];
    done.store(pixels, std::memory_order_release);
    if (threads > 1 && (pixels % ahead == 0 || pixels == w)) done.notify_all();
  }
};

/// The pixel before on a path, whose path costs begin at `costs`. Where a path begins that is a cell of zeros.
HWY_INLINE Before before(const Sweep& sweep, const std::uint8_t* costs, const std::uint8_t* least, int gray, int gray_before) {
  return Before(costs, least, &sweep.p2_more[std::abs(gray - gray_before)], sweep.in.params.p1);
}

/// Calls f(lane, whether some of the vector's lanes hold no disparity) for each vector.
template <class F>
HWY_INLINE void each_vector(const Sweep& sweep, const F& f) {
  const int n = static_cast<int>(hn::Lanes(D()));
  int j = sweep.first;
  if (sweep.partly) f(j, std::true_type()), j += n;
  for (; j < sweep.lanes; j += n) f(j, std::false_type());
}

/// What a path begins with; the lane before the first one stays 255.
void zero_cell(const Sweep& sweep, std::uint8_t* costs) {
  std::memset(costs + sweep.first, 0, static_cast<std::size_t>(sweep.lanes - sweep.first));
}

/// What a row's walk is for: its sums of paths from below; all but the last path, before the winners; only the paths to the
/// next row.
enum class Walk { kUp, kDown, kPassing };

/// A row on its way from left to right.
template <Walk kWalk, bool kDiagonals>
class Along {
 public:
  static constexpr int kPaths = kDiagonals ? 3 : 1;
  static constexpr bool kUp = kWalk == Walk::kUp, kDown = kWalk == Walk::kDown;

  Along(const Sweep& sweep, int i, Scratch::Row& row)
      : sweep_(sweep),
        row_(row),
        left_(sweep.in.left, sweep.y_of(i), 0),
        right_(sweep.in.right, sweep.y_of(i), 1 - sweep.lanes) {
    const int ring = sweep.threads + 1, y = sweep.y_of(i);
    Scratch& s = sweep.s;
    const auto here = static_cast<std::size_t>(i % ring), above = static_cast<std::size_t>((i + ring - 1) % ring);
    for (int k = 0; k < kPaths; ++k) {
      paths_[k] = s.first_cell(s.paths[here].row(k));
      minima_[k] = s.minima[here].row(k) + 1;
      paths_above_[k] = i > 0 ? s.first_cell(s.paths[above].row(k)) : s.none.row(0) + kGap;
      minima_above_[k] = (i > 0 ? s.minima[above].row(k) : s.none.row(0)) + 1;
    }
    stride_above_ = i > 0 ? s.stride : 0;
    gray_above_ = sweep.in.left.value[0].row(sweep.y_of(std::max(i - 1, 0)));
    before_ = row.along.row(0) + kGap;
    zero_cell(sweep, before_);
    here_ = row.along.row(1) + kGap;
    if (kUp || (kDown && sweep.in.params.upward)) upward_ = s.upward.row(y);
  }

  /// Costs of a block of pixels. By themselves, as nothing here waits for the pixel before: mixed with the paths they take
  /// twice the time.
  HWY_NOINLINE void costs(int begin, int end) {
    const D d;
    const int n = static_cast<int>(hn::Lanes(d)), first = sweep_.first, lanes = sweep_.lanes;
    const auto unused = hn::Load(d, sweep_.unused);
    for (int x = begin; x < end; ++x) {
      const PixelCost cost_of(left_, right_, sweep_.in.params, x);
      std::uint8_t* const costs = row_.costs.row(0) + static_cast<std::ptrdiff_t>(x) * lanes;
      hn::Store(hn::Or(cost_of.at(first), unused), d, costs + first);
      for (int j = first + n; j < lanes; j += n) hn::Store(cost_of.at(j), d, costs + j);
    }
  }

  HWY_INLINE void pixel(int x) {
    const D d;
    const int first = sweep_.first, lanes = sweep_.lanes;
    const std::ptrdiff_t stride = sweep_.s.stride, cell = static_cast<std::ptrdiff_t>(x) * lanes;
    const std::uint8_t* gray = left_.value[0];
    const Before from_left = before(sweep_, before_, &least_, gray[x], gray[x - 1]);
    constexpr int kFrom[3] = {0, kDiagonals ? -1 : 0, kDiagonals ? 1 : 0};
    const auto above = [&](int k) HWY_ATTR {
      const int from = x + kFrom[k];
      return before(sweep_, paths_above_[k] + from * stride_above_, minima_above_[k] + from, gray[x], gray_above_[from]);
    };
    const Before from_above[3] = {above(0), above(kDiagonals ? 1 : 0), above(kDiagonals ? 2 : 0)};
    std::uint8_t *const here = here_, *const sums = (kUp ? upward_ : row_.sums.row(0)) + cell,
                        *const costs = row_.costs.row(0) + cell;
    std::uint8_t* const paths[3] = {paths_[0] + x * stride, paths_[kPaths / 2] + x * stride, paths_[kPaths - 1] + x * stride};
    const std::uint8_t* const below = kDown && upward_ != nullptr ? upward_ + cell : nullptr;
    if (below != nullptr && x + kFetchAhead < sweep_.w)
      for (int j = first / kLine * kLine; j < lanes; j += kLine) hwy::Prefetch(below + kFetchAhead * lanes + j);
    auto least_left = set(255);
    V least_above[3] = {least_left, least_left, least_left};
    each_vector(sweep_, [&](int j, auto unused) HWY_ATTR {
      constexpr bool kUnused = decltype(unused)::value;
      const auto cost = hn::Load(d, costs + j);
      auto sum = hn::Zero(d);
      if (kDown) {
        sum = from_left.template step<kUnused>(j, cost);
        hn::Store(sum, d, here + j);
        least_left = hn::Min(least_left, sum);
        if (below != nullptr) sum = hn::SaturatedAdd(sum, hn::Load(d, below + j));
      }
      for (int k = 0; k < kPaths; ++k) {
        const auto l = from_above[k].template step<kUnused>(j, cost);
        hn::Store(l, d, paths[k] + j);
        least_above[k] = hn::Min(least_above[k], l);
        sum = hn::SaturatedAdd(sum, l);
      }
      if (kUp) hn::Stream(sum, d, sums + j);  // not needed for long
      if (kDown) hn::Store(sum, d, sums + j);
    });
    if constexpr (kDiagonals) {
      const std::uint32_t all = least(d, least_left, least_above[0], least_above[1], least_above[2]);
      least_ = static_cast<std::uint8_t>(all);
      for (int k = 0; k < kPaths; ++k) minima_[k][x] = static_cast<std::uint8_t>(all >> 8 * (k + 1));
    } else {
      const int pair = least(d, least_left, least_above[0]);
      least_ = static_cast<std::uint8_t>(first_of(pair));
      minima_[0][x] = static_cast<std::uint8_t>(second_of(pair));
    }
    std::swap(before_, here_);
  }

 private:
  const Sweep& sweep_;
  Scratch::Row& row_;
  RowPlanes left_, right_;
  std::uint8_t *paths_[3] = {}, *minima_[3] = {};
  const std::uint8_t *paths_above_[3] = {}, *minima_above_[3] = {}, *gray_above_ = nullptr;
  std::ptrdiff_t stride_above_;
  std::uint8_t *before_, *here_, *upward_ = nullptr;
  std::uint8_t least_ = 0;
};

/// The same row on its way back: adds the last path and picks the winners.
class Back {
 public:
  Back(const Sweep& sweep, int y, Scratch::Row& row)
      : sweep_(sweep),
        row_(row),
        y_(y),
        gray_(sweep.in.left.value[0].row(y)),
        before_(row.back.row(0) + kGap),
        here_(row.back.row(1) + kGap) {
    zero_cell(sweep, before_);
    std::memset(row.best.row(0), 255, static_cast<std::size_t>(sweep.lanes + sweep.w));
  }

  HWY_INLINE void pixel(int x) {
    const D d;
    const int lanes = sweep_.lanes;
    const Before from_right = before(sweep_, before_, &least_, gray_[x], gray_[x + 1]);
    const std::ptrdiff_t cell = static_cast<std::ptrdiff_t>(x) * lanes;
    const std::uint8_t *const sums = row_.sums.row(0) + cell, *const costs = row_.costs.row(0) + cell;
    // Of the right pixel x - d: lane 0 is x + 1 - lanes, and both rows begin `lanes` before x = 0.
    std::uint8_t *const best = row_.best.row(0) + x + 1, *const winner = row_.winner.row(0) + x + 1;
    std::uint8_t *const here = here_, *const totals = row_.totals.row(0) + kGap;
    auto least_right = set(255), least_total = least_right;
    each_vector(sweep_, [&](int j, auto unused) HWY_ATTR {
      const auto l = from_right.template step<decltype(unused)::value>(j, hn::Load(d, costs + j));
      hn::Store(l, d, here + j);
      least_right = hn::Min(least_right, l);
      const auto total = hn::SaturatedAdd(hn::Load(d, sums + j), l);
      hn::Store(total, d, totals + j);
      least_total = hn::Min(least_total, total);
      // x falls, and with it d of the same right pixel: an equal one replaces it.
      const auto best_now = hn::Min(total, hn::LoadU(d, best + j));
      const auto better = hn::Eq(best_now, total);
      hn::StoreU(best_now, d, best + j);
      hn::StoreU(hn::IfThenElse(better, hn::Load(d, sweep_.disparities + j), hn::LoadU(d, winner + j)), d, winner + j);
    });
    const int pair = least(d, least_right, least_total);
    least_ = static_cast<std::uint8_t>(first_of(pair));
    pick(x, totals, second_of(pair));
    std::swap(before_, here_);
  }

  void finish() {
    std::int16_t* out = sweep_.out.right.row(y_);
    const std::uint8_t* winner = row_.winner.row(0) + sweep_.lanes;
    for (int x = 0; x < sweep_.w; ++x) out[x] = winner[x];
    interpolate();
  }

 private:
  /// The left winner of a pixel: the last lane that holds the least.
  HWY_INLINE void pick(int x, std::uint8_t* totals, int least_total) {
    const D d;
    const int n = static_cast<int>(hn::Lanes(d)), lanes = sweep_.lanes;
    int lane = 0;
    for (int j = sweep_.first; j < lanes; j += n) {
      std::uint64_t bits = 0;
      hn::StoreMaskBits(d, hn::Eq(hn::Load(d, totals + j), set(least_total)), reinterpret_cast<std::uint8_t*>(&bits));
      lane = bits != 0 ? j + 63 - std::countl_zero(bits) : lane;
    }
    sweep_.out.left.row(y_)[x] = static_cast<std::int16_t>(lanes - 1 - lane);
    row_.beside.row(0)[x] = static_cast<std::uint8_t>(totals[lane + 1] - least_total);
    row_.beside.row(1)[x] = static_cast<std::uint8_t>(totals[lane - 1] - least_total);
    if (!sweep_.out.margin.empty()) sweep_.out.margin.row(y_)[x] = static_cast<std::uint8_t>(margin(totals, lane, least_total));
  }

  /// The sub-pixel offsets of a row.
  void interpolate() {
    const hn::ScalableTag<std::int32_t> many;
    const hn::CappedTag<std::int32_t, 1> one;
    const int n = static_cast<int>(hn::Lanes(many));
    int x = 0;
    for (; x + n <= sweep_.w; x += n) interpolate(many, x);
    for (; x < sweep_.w; ++x) interpolate(one, x);
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

  int margin(std::uint8_t* totals, int lane, int least_total) const {
    const D d;
    // The winner and its neighbours do not count; what lies before the first lane and behind the last is never read.
    totals[lane - 1] = totals[lane] = totals[lane + 1] = 255;
    auto second = set(255);
    for (int j = sweep_.first; j < sweep_.lanes; j += static_cast<int>(hn::Lanes(d)))
      second = hn::Min(second, hn::Load(d, totals + j));
    return first_of(least(d, second, second)) - least_total;
  }

  const Sweep& sweep_;
  Scratch::Row& row_;
  int y_;
  const std::uint8_t* gray_;
  std::uint8_t *before_, *here_;
  std::uint8_t least_ = 0;
};

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
