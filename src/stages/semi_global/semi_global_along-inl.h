// A row's walk along its columns, and what all rows of a sweep share. Included once for each instruction set.

#include <cstring>
#include <type_traits>

#include "stages/semi_global/semi_global_costs-inl.h"

#if defined(DUO_SEMI_GLOBAL_ALONG_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DUO_SEMI_GLOBAL_ALONG_INL_H
#undef DUO_SEMI_GLOBAL_ALONG_INL_H
#else
#define DUO_SEMI_GLOBAL_ALONG_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {

using Part = simd::SemiGlobalPart;

constexpr int kSpins = 20;  // about a microsecond
// The volume comes from main memory, and what fetches ahead by itself stops at each page.
constexpr int kFetchAhead = 16, kLine = 64;  // pixels, bytes

/// What all rows of one sweep share, as one thread sees it.
struct Sweep {
  const SemiGlobal& in;
  Scratch& s;
  const SemiGlobalMatch& out;
  const Part part;
  int w, h, lanes, first;     // first: lane of the first vector that holds a disparity
  int ahead;                  // pixels that a row gets ahead of the next one: with all threads at work, half of what it could
  bool partly;                // that first vector has lanes which hold none
  std::uint8_t p2_more[256];  // [gray step]: P2 - P1
  HWY_ALIGN_MAX std::uint8_t disparities[256];  // of the lanes

  Sweep(const SemiGlobal& in_, Scratch& scratch, const SemiGlobalMatch& out_, const Part& part_)
      : in(in_), s(scratch), out(out_), part(part_), w(in.left.size().width), h(in.left.size().height), lanes(s.lanes) {
    const int n = static_cast<int>(hn::Lanes(D()));
    first = (lanes - in.max_disparity) / n * n;
    partly = first < lanes - in.max_disparity;
    for (int j = 0; j < lanes; ++j) disparities[j] = static_cast<std::uint8_t>(lanes - 1 - j);
    ahead = std::max(1, part.width() / (2 * part.threads * kBlock)) * kBlock;
    for (int i = 0; i < 256; ++i) p2_more[i] = static_cast<std::uint8_t>(in.params.p2_at(i) - in.params.p1);
  }

  int y_of(int i) const { return part.up ? h - 1 - i : i; }

  /// For a thread of the same team. Who caught up lets the row above get ahead, so that not each block ends with waiting, and
  /// is woken in such steps only: a call into the kernel takes longer than a block.
  void wait_for(int i, int pixels) const {
    const std::atomic<int>& done = part.done[i];
    if (done.load(std::memory_order_acquire) < pixels) wait_until(done, std::min(part.width(), pixels + ahead));
  }
  /// For the other half of row i. Who caught up lets the other get half as far ahead as it may; that row's end comes after
  /// those of all rows above.
  void wait_for_facing(int i) const {
    if (part.facing == nullptr || part.facing[i].load(std::memory_order_acquire) == part.facing_width) return;
    wait_until(part.facing[std::min(part.count - 1, i + Scratch::kBehind / 2 * part.threads)], part.facing_width);
  }
  /// For the sweep from the other side, until all its sums are in the volume.
  void wait_for_sums() const {
    if (part.sums_of_others != nullptr) wait_until(*part.sums_of_others, part.threads);
  }
  void sums_are_there() const {
    hwy::FlushStream();
    if (part.sums == nullptr) return;
    part.sums->fetch_add(1, std::memory_order_release);
    part.sums->notify_all();
  }
  void finished(int i, int pixels) const {
    std::atomic<int>& done = part.done[i];
    done.store(pixels, std::memory_order_release);
    if ((part.threads == 1 || pixels % ahead != 0) && pixels != part.width()) return;
    // Else who is about to wait may not see the store yet, and this not see who waits.
    std::atomic_thread_fence(std::memory_order_seq_cst);
    done.notify_all();
  }

 private:
  /// Spins a little, then gives the core away.
  static void wait_until(const std::atomic<int>& done, int pixels) {
    int spins = 0;
    for (int now = done.load(std::memory_order_acquire); now < pixels; now = done.load(std::memory_order_acquire)) {
      hwy::Pause();
      if (++spins > kSpins) done.wait(now, std::memory_order_acquire);
    }
  }
};

/// The pixel before on a path, whose path costs begin at `costs`. Where a path begins that is a cell of zeros.
HWY_INLINE Before before(const Sweep& sweep, const std::uint8_t* costs, const std::uint8_t* least, int gray, int gray_before) {
  return Before(costs, least, &sweep.p2_more[std::abs(gray - gray_before)], sweep.in.params.p1);
}

/// What is known of the lanes when the program is made: nothing, or that they are so many vectors, and that there is no volume.
constexpr int kAnyVectors = 0;
template <int kVectors>
HWY_INLINE int lanes_of(const Sweep& sweep) {
  return kVectors != kAnyVectors ? (kVectors * kMostLanes + kGap - 1) / kGap * kGap : sweep.lanes;
}
template <int kVectors>
HWY_INLINE int first_lane(const Sweep& sweep) {
  return kVectors != kAnyVectors ? lanes_of<kVectors>(sweep) - kVectors * kMostLanes : sweep.first;
}

/// Calls f(lane, whether some of the vector's lanes hold no disparity) for each vector.
template <int kVectors, class F>
HWY_INLINE void each_vector(const Sweep& sweep, const F& f) {
  const int n = static_cast<int>(hn::Lanes(D()));
  if constexpr (kVectors != kAnyVectors) {
    const int first = first_lane<kVectors>(sweep);
    f(first, std::true_type());
    for (int v = 1; v < kVectors; ++v) f(first + v * kMostLanes, std::false_type());
    return;
  }
  int j = sweep.first;
  if (sweep.partly) f(j, std::true_type()), j += n;
  for (; j < sweep.lanes; j += n) f(j, std::false_type());
}

/// What a path begins with; the lane before the first one stays 255.
void zero_cell(const Sweep& sweep, std::uint8_t* costs) {
  std::memset(costs + sweep.first, 0, static_cast<std::size_t>(sweep.lanes - sweep.first));
}

/// What a row's walk is for: only the paths to the next row; their sums, for the volume; all but the last path, before the
/// winners.
enum class Walk { kPass, kKeep, kPick };

/// A row on its way: from left to right, step 1, or from right to left, step -1.
template <Walk kWalk, bool kDiagonals, int kStep>
class Along {
 public:
  static constexpr int kPaths = kDiagonals ? 3 : 1;
  static constexpr bool kKeep = kWalk == Walk::kKeep, kPick = kWalk == Walk::kPick;

  Along(const Sweep& sweep, int i, Scratch::Row& row)
      : sweep_(sweep),
        row_(row),
        costs_(sweep.in, sweep.y_of(i), sweep.lanes),
        gray_(sweep.in.left.value[0].row(sweep.y_of(i))) {
    const int ring = sweep.part.threads + 1, y = sweep.y_of(i);
    Scratch& s = sweep.s;
    const auto here = static_cast<std::size_t>(sweep.part.ring + i % ring);
    const auto above = static_cast<std::size_t>(sweep.part.ring + (i + ring - 1) % ring);
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
    if (kKeep || (kPick && sweep.in.params.upward)) kept_ = s.volume.row(y);
  }

  /// Costs of a block of pixels. By themselves, as nothing here waits for the pixel before: mixed with the paths they take
  /// twice the time.
  void costs(int begin, int end) { costs_.block(begin, end, row_.costs.row(0)); }

  template <int kVectors>
  HWY_INLINE void pixel(int x) {
    const D d;
    const int first = first_lane<kVectors>(sweep_), lanes = lanes_of<kVectors>(sweep_);
    const std::ptrdiff_t stride = sweep_.s.stride, cell = static_cast<std::ptrdiff_t>(x) * lanes;
    // Where a path begins, beside the picture, the gray step does not matter: no step is dearer than none from zeros.
    const Before from_side = before(sweep_, before_, &least_, gray_[x], gray_[x - kStep]);
    constexpr int kFrom[3] = {0, kDiagonals ? -1 : 0, kDiagonals ? 1 : 0};
    const auto above = [&](int k) HWY_ATTR {
      const int from = x + kFrom[k];
      return before(sweep_, paths_above_[k] + from * stride_above_, minima_above_[k] + from, gray_[x], gray_above_[from]);
    };
    const Before from_above[3] = {above(0), above(kDiagonals ? 1 : 0), above(kDiagonals ? 2 : 0)};
    std::uint8_t *const here = here_, *const sums = (kKeep ? kept_ : row_.sums.row(0)) + cell,
                        *const costs = row_.costs.row(0) + cell;
    std::uint8_t* const paths[3] = {paths_[0] + x * stride, paths_[kPaths / 2] + x * stride, paths_[kPaths - 1] + x * stride};
    const std::uint8_t* const kept = kPick && kVectors == kAnyVectors && kept_ != nullptr ? kept_ + cell : nullptr;
    if (kVectors == kAnyVectors && kept != nullptr && x + kFetchAhead < sweep_.w)
      for (int j = first / kLine * kLine; j < lanes; j += kLine) hwy::Prefetch(kept + kFetchAhead * lanes + j);
    auto least_side = set(255);
    V least_above[3] = {least_side, least_side, least_side};
    each_vector<kVectors>(sweep_, [&](int j, auto unused) HWY_ATTR {
      constexpr bool kUnused = decltype(unused)::value;
      const auto cost = hn::Load(d, costs + j);
      auto sum = hn::Zero(d);
      if (kPick) {
        sum = from_side.template step<kUnused>(j, cost);
        hn::Store(sum, d, here + j);
        least_side = hn::Min(least_side, sum);
        if (kVectors == kAnyVectors && kept != nullptr) sum = hn::SaturatedAdd(sum, hn::Load(d, kept + j));
      }
      for (int k = 0; k < kPaths; ++k) {
        const auto l = from_above[k].template step<kUnused>(j, cost);
        hn::Store(l, d, paths[k] + j);
        least_above[k] = hn::Min(least_above[k], l);
        sum = hn::SaturatedAdd(sum, l);
      }
      if (kKeep) hn::Stream(sum, d, sums + j);  // not needed for long
      if (kPick) hn::Store(sum, d, sums + j);
    });
    if constexpr (kDiagonals) {
      const std::uint32_t all = least(d, least_side, least_above[0], least_above[1], least_above[2]);
      least_ = static_cast<std::uint8_t>(all);
      for (int k = 0; k < kPaths; ++k) minima_[k][x] = static_cast<std::uint8_t>(all >> 8 * (k + 1));
    } else {
      const int pair = least(d, least_side, least_above[0]);
      least_ = static_cast<std::uint8_t>(first_of(pair));
      minima_[0][x] = static_cast<std::uint8_t>(second_of(pair));
    }
    std::swap(before_, here_);
  }

  /// What the other half's way back begins with.
  void meet(int i) const {
    std::memcpy(sweep_.s.met(kStep > 0 ? 0 : 1, i) + sweep_.first, before_ + sweep_.first,
                static_cast<std::size_t>(sweep_.lanes - sweep_.first));
    sweep_.s.met_least.row(kStep > 0 ? 0 : 1)[i] = least_;
  }

 private:
  const Sweep& sweep_;
  Scratch::Row& row_;
  RowCosts costs_;
  const std::uint8_t* gray_;
  std::uint8_t *paths_[3] = {}, *minima_[3] = {};
  const std::uint8_t *paths_above_[3] = {}, *minima_above_[3] = {}, *gray_above_ = nullptr;
  std::ptrdiff_t stride_above_;
  std::uint8_t *before_, *here_, *kept_ = nullptr;
  std::uint8_t least_ = 0;
};

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
