// Lanes are disparities, downwards: lane j is d = lanes - 1 - j, so that the right pixels x - d of a left pixel lie in order in
// memory. One sweep goes down the rows. On its way along a row each pixel's cost is worked out once, the paths from the left
// and from above are brought up to date together, and their sum stays in the cache; on the way back along the row the path from
// the right is added and both views' winners are picked. Nothing but a few rows is kept. Paths from below need a sweep of their
// own before it, which leaves one byte for each pixel and disparity. Threads take rows in turn; a row may go on as far as the
// row before it is done.

#include <bit>
#include <cstring>
#include <thread>

#include "core/check.h"
#include "stages/semi_global/semi_global.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/semi_global/semi_global_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<std::uint8_t, simd::SemiGlobalScratch::kGap>;
using V = hn::Vec<D>;
using Scratch = simd::SemiGlobalScratch;

constexpr int kGap = Scratch::kGap;
constexpr int kBlock = 32;  // pixels between two looks at the row before

HWY_INLINE V set(int value) { return hn::Set(D(), static_cast<std::uint8_t>(value)); }

/// The least of all lanes.
template <class DV>
HWY_INLINE int least(DV d, hn::Vec<DV> v) {
  if constexpr (hn::MaxLanes(DV()) > 16) {
    const hn::Half<DV> half;
    return least(half, hn::Min(hn::LowerHalf(half, v), hn::UpperHalf(half, v)));
  } else {
    v = hn::Min(v, hn::ShiftRightBytes<8>(d, v));
    v = hn::Min(v, hn::ShiftRightBytes<4>(d, v));
    v = hn::Min(v, hn::ShiftRightBytes<2>(d, v));
    return std::min(hn::GetLane(v), hn::GetLane(hn::ShiftRightBytes<1>(d, v)));
  }
}

/// What the pixel before on a path left behind.
struct Before {
  const std::uint8_t* costs;  // lane 0 of its path costs
  V least, jump, p1;
  Before(const std::uint8_t* costs_, int least_, int p2, int p1_)
      : costs(costs_), least(set(least_)), jump(set(least_ + p2)), p1(set(p1_)) {}

  HWY_INLINE V step(int j, V cost) const {
    const D d;
    const auto beside = hn::Min(hn::LoadU(d, costs + j - 1), hn::LoadU(d, costs + j + 1));
    const auto best = hn::Min(hn::Min(hn::Load(d, costs + j), hn::SaturatedAdd(beside, p1)), jump);
    return hn::SaturatedAdd(cost, hn::Sub(best, least));
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
    outside = planes.outside.empty() ? nullptr : planes.outside.row(y) + offset;
  }
};

/// One pixel's side of the cost, broadcast.
template <bool kMasked>
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
    if (kMasked) outside = set(left.outside[x]);
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
    if (kMasked) {
      const auto all = hn::Add(census_most, hn::Add(most, hn::Add(most, most)));
      sum = hn::Max(sum, hn::And(all, hn::Or(outside, load(right.outside))));
    }
    return sum;
  }
};

/// One sweep down (or up) the picture, as one thread sees it.
class Sweep {
 public:
  Sweep(const SemiGlobal& in, Scratch& scratch, const SemiGlobalMatch& out, int thread, int threads, bool up)
      : in_(in),
        s_(scratch),
        out_(out),
        row_(scratch.rows[static_cast<std::size_t>(thread)]),
        thread_(thread),
        threads_(threads),
        up_(up),
        w_(in.left.size().width),
        h_(in.left.size().height),
        lanes_(scratch.lanes) {
    const int n = static_cast<int>(hn::Lanes(D()));
    first_ = (lanes_ - in.max_disparity) / n * n;
    for (int i = 0; i < 256; ++i) p2_[i] = in.params.p2_at(i);
    for (int j = 0; j < kGap; ++j) unused_[j] = first_ + j < lanes_ - in.max_disparity ? 255 : 0;
  }

  void run() {
    for (int i = thread_; i < h_; i += threads_) {
      const bool masked = !in_.left.outside.empty();
      if (up_)
        masked ? along<true, true>(i) : along<true, false>(i);
      else
        masked ? along<false, true>(i) : along<false, false>(i);
      if (!up_) back(i);
    }
  }

 private:
  int y_of(int i) const { return up_ ? h_ - 1 - i : i; }

  void wait_for(int i, int pixels) const {
    const std::atomic<int>& done = s_.done[static_cast<std::size_t>(i)];
    for (int spins = 0; done.load(std::memory_order_acquire) < pixels; ++spins)
      if (spins > 200) std::this_thread::yield();
  }

  /// Path costs of direction k (0 straight, 1 from x - 1, 2 from x + 1) in row i of the sweep.
  std::uint8_t* path(int i, int k, int x) const {
    return s_.paths[static_cast<std::size_t>(i % (threads_ + 1))].row(k) + kGap + static_cast<std::ptrdiff_t>(x) * s_.stride;
  }
  std::uint8_t& minimum(int i, int k, int x) const { return s_.minima[static_cast<std::size_t>(i % (threads_ + 1))].row(k)[x]; }

  Before before(int i, int k, int y, int x) const {
    const int from = k == 0 ? x : k == 1 ? x - 1 : x + 1;
    if (i == 0 || from < 0 || from >= w_) return Before(s_.none.row(0) + kGap, 0, 0, 0);
    const View<const std::uint8_t> gray = in_.left.value[0];
    const int step = std::abs(gray.at(y, x) - gray.at(y_of(i - 1), from));
    return Before(path(i - 1, k, from), minimum(i - 1, k, from), p2_[step], in_.params.p1);
  }

  Before beside(const std::uint8_t* costs, int least, int y, int x, int from) const {
    const View<const std::uint8_t> gray = in_.left.value[0];
    if (from < 0 || from >= w_) return Before(s_.none.row(0) + kGap, 0, 0, 0);
    return Before(costs, least, p2_[std::abs(gray.at(y, x) - gray.at(y, from))], in_.params.p1);
  }

  /// Row i from left to right. Up: sums go to the volume; else to the thread's row, with the costs and the path along the row.
  template <bool kUp, bool kMasked>
  void along(int i) {
    in_.params.diagonals ? along<kUp, kMasked, true>(i) : along<kUp, kMasked, false>(i);
  }

  template <bool kUp, bool kMasked, bool kDiagonals>
  void along(int i) {
    const D d;
    const int n = static_cast<int>(hn::Lanes(d)), y = y_of(i);
    constexpr int kPaths = kDiagonals ? 3 : 1;
    std::uint8_t* horizontal[2] = {row_.path.row(0) + kGap, row_.path.row(1) + kGap};
    const RowPlanes left(in_.left, y, 0), right(in_.right, y, 1 - lanes_);
    const SemiGlobalParams params = in_.params;
    int last_least = 0;
    for (int x = 0; x < w_; ++x) {
      if (x % kBlock == 0 && i > 0) wait_for(i - 1, std::min(w_, x + kBlock + 1));
      const PixelCost<kMasked> pixel(left, right, params, x);
      const Before from_left = beside(horizontal[0], last_least, y, x, x - 1);
      const Before above[3] = {before(i, 0, y, x), before(i, kDiagonals ? 1 : 0, y, x), before(i, kDiagonals ? 2 : 0, y, x)};
      const std::ptrdiff_t cell = static_cast<std::ptrdiff_t>(x) * lanes_;
      std::uint8_t* sums = kUp ? s_.upward.row(y) + cell : row_.sums.row(0) + cell;
      std::uint8_t* costs = row_.costs.row(0) + cell;
      const std::uint8_t* below = params.upward ? s_.upward.row(y) + cell : nullptr;
      std::uint8_t *from_here = horizontal[1], *paths[3];
      for (int k = 0; k < kPaths; ++k) paths[k] = path(i, k, x);
      const int first = first_, lanes = lanes_;
      auto least_left = set(255);
      V least_above[3] = {least_left, least_left, least_left};
      for (int j = first; j < lanes; j += n) {
        auto cost = pixel.at(j);
        if (j == first) cost = hn::Or(cost, hn::Load(d, unused_));
        auto sum = hn::Zero(d);
        if (!kUp) {
          hn::Store(cost, d, costs + j);
          sum = from_left.step(j, cost);
          hn::Store(sum, d, from_here + j);
          least_left = hn::Min(least_left, sum);
          if (params.upward) sum = hn::SaturatedAdd(sum, hn::Load(d, below + j));
        }
        for (int k = 0; k < kPaths; ++k) {
          const auto l = above[k].step(j, cost);
          hn::Store(l, d, paths[k] + j);
          least_above[k] = hn::Min(least_above[k], l);
          sum = hn::SaturatedAdd(sum, l);
        }
        hn::Store(sum, d, sums + j);
      }
      if (!kUp) last_least = least(d, least_left);
      for (int k = 0; k < kPaths; ++k) minimum(i, k, x) = static_cast<std::uint8_t>(least(d, least_above[k]));
      std::swap(horizontal[0], horizontal[1]);
      if (x % kBlock == kBlock - 1 || x == w_ - 1) s_.done[static_cast<std::size_t>(i)].store(x + 1, std::memory_order_release);
    }
  }

  /// Row y from right to left: adds the last path and picks the winners.
  void back(int y) {
    const D d;
    const int n = static_cast<int>(hn::Lanes(d)), pad = lanes_;
    std::uint8_t* horizontal[2] = {row_.path.row(0) + kGap, row_.path.row(1) + kGap};
    std::uint8_t *totals = row_.totals.row(0) + kGap, *best = row_.best.row(0) + pad, *winner = row_.winner.row(0) + pad;
    std::memset(best - pad, 255, static_cast<std::size_t>(pad + w_));
    int last_least = 0;
    for (int x = w_ - 1; x >= 0; --x) {
      const Before from_right = beside(horizontal[0], last_least, y, x, x + 1);
      const std::ptrdiff_t cell = static_cast<std::ptrdiff_t>(x) * lanes_, right = x - lanes_ + 1;
      const std::uint8_t *sums = row_.sums.row(0) + cell, *costs = row_.costs.row(0) + cell;
      std::uint8_t* from_here = horizontal[1];
      const int first = first_, lanes = lanes_;
      auto least_right = set(255), least_total = least_right;
      for (int j = first; j < lanes; j += n) {
        const auto l = from_right.step(j, hn::Load(d, costs + j));
        hn::Store(l, d, from_here + j);
        least_right = hn::Min(least_right, l);
        const auto total = hn::SaturatedAdd(hn::Load(d, sums + j), l);
        hn::Store(total, d, totals + j);
        least_total = hn::Min(least_total, total);
        // x falls, and with it d of the same right pixel: an equal one replaces it.
        const auto best_now = hn::Min(total, hn::LoadU(d, best + right + j));
        const auto better = hn::Eq(best_now, total);
        hn::StoreU(best_now, d, best + right + j);
        const auto disparity = hn::Sub(set(lanes - 1 - j), hn::Iota(d, 0));
        hn::StoreU(hn::IfThenElse(better, disparity, hn::LoadU(d, winner + right + j)), d, winner + right + j);
      }
      last_least = least(d, least_right);
      pick(y, x, totals, least(d, least_total));
      std::swap(horizontal[0], horizontal[1]);
    }
    std::int16_t* out = out_.right.row(y);
    for (int x = 0; x < w_; ++x) out[x] = winner[x];
  }

  /// The left winner of a pixel: the last lane that holds the least.
  HWY_INLINE void pick(int y, int x, std::uint8_t* totals, int least_total) {
    const D d;
    const int n = static_cast<int>(hn::Lanes(d));
    int lane = first_;
    for (int j = lanes_ - n; j >= first_; j -= n) {
      std::uint64_t bits = 0;
      hn::StoreMaskBits(d, hn::Eq(hn::Load(d, totals + j), set(least_total)), reinterpret_cast<std::uint8_t*>(&bits));
      if (bits == 0) continue;
      lane = j + 63 - std::countl_zero(bits);
      break;
    }
    const int disparity = lanes_ - 1 - lane;
    out_.left.at(y, x) = static_cast<std::int16_t>(disparity);
    int offset = 0;
    if (disparity > 0 && disparity + 1 < in_.max_disparity) {
      const int below = totals[lane + 1], beyond = totals[lane - 1], curvature = below + beyond - 2 * least_total;
      const int size = curvature == 0 ? 0 : (8 * std::abs(below - beyond) + curvature / 2) / curvature;
      offset = below < beyond ? -size : size;
    }
    out_.fine.at(y, x) = static_cast<std::uint16_t>(16 * disparity + offset);
    if (!out_.margin.empty()) out_.margin.at(y, x) = static_cast<std::uint8_t>(margin(totals, lane, least_total));
  }

  int margin(std::uint8_t* totals, int lane, int least_total) const {
    const D d;
    // The winner and its neighbours do not count; what lies before the first lane and behind the last is never read.
    totals[lane - 1] = totals[lane] = totals[lane + 1] = 255;
    auto second = set(255);
    for (int j = first_; j < lanes_; j += static_cast<int>(hn::Lanes(d))) second = hn::Min(second, hn::Load(d, totals + j));
    return least(d, second) - least_total;
  }

  const SemiGlobal& in_;
  Scratch& s_;
  const SemiGlobalMatch& out_;
  Scratch::Row& row_;
  int thread_, threads_;
  bool up_;
  int w_, h_, lanes_, first_;
  int p2_[256];
  HWY_ALIGN_MAX std::uint8_t unused_[kGap];
};

void sweep(const SemiGlobal& in, Scratch& scratch, const SemiGlobalMatch& out, int thread, int threads, bool up) {
  Sweep(in, scratch, out, thread, threads, up).run();
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(sweep);

namespace simd {

SemiGlobalScratch::SemiGlobalScratch(Size size, int max_disparity, const SemiGlobalParams& params, int threads)
    : lanes(padding(max_disparity)),
      stride(lanes + kGap),
      none({lanes + 2 * kGap, 1}),
      rows(static_cast<std::size_t>(threads)) {
  const int directions = params.diagonals ? 3 : 1;
  const auto fill = [](Image<std::uint8_t>& image) {
    for (int y = 0; y < image.height(); ++y) std::memset(image.row(y), 255, static_cast<std::size_t>(image.width()));
  };
  for (int i = 0; i <= threads; ++i) {
    paths.emplace_back(Size{size.width * stride + 2 * kGap, directions});
    fill(paths.back());
    minima.emplace_back(Size{size.width, directions});
  }
  for (Row& row : rows) {
    row.sums = Image<std::uint8_t>({size.width * lanes, 1});
    row.costs = Image<std::uint8_t>({size.width * lanes, 1});
    row.path = Image<std::uint8_t>({lanes + 2 * kGap, 2});
    fill(row.path);
    row.totals = Image<std::uint8_t>({lanes + 2 * kGap, 1});
    row.best = Image<std::uint8_t>({lanes + size.width, 1});
    row.winner = Image<std::uint8_t>({lanes + size.width, 1});
  }
  if (params.upward) upward = Image<std::uint8_t>({size.width * lanes, size.height});
  done = std::make_unique<std::atomic<int>[]>(static_cast<std::size_t>(size.height));
}

void semi_global(Pool& pool, const SemiGlobal& in, SemiGlobalScratch& scratch, const SemiGlobalMatch& out) {
  const Size size = in.left.size();
  DUO_CHECK(in.max_disparity >= 1 && in.max_disparity <= 256 && scratch.lanes == SemiGlobalScratch::padding(in.max_disparity));
  DUO_CHECK(out.left.size() == size && out.right.size() == size && out.fine.size() == size);
  DUO_CHECK(static_cast<int>(scratch.rows.size()) >= pool.threads());
  const int threads = std::min(pool.threads(), size.height);
  for (const bool up : {true, false}) {
    if (up && !in.params.upward) continue;
    for (int y = 0; y < size.height; ++y) scratch.done[static_cast<std::size_t>(y)].store(0, std::memory_order_relaxed);
    const auto run = HWY_DYNAMIC_DISPATCH(sweep);
    pool.rows(pool.threads(), [&](int begin, int, int) {
      if (begin < threads) run(in, scratch, out, begin, threads, up);
    });
  }
}

}  // namespace simd
}  // namespace duo
#endif
