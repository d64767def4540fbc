// Lanes are disparities, downwards, as in semi_global_simd.cpp. Nothing is kept but the sums, in the volume itself: the costs
// take less time to be worked out twice than to be read from memory. First rows with their paths from both sides, each by one
// thread; then columns with the path from above, which is the last one, so that energies take the place of the sums.

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "core/check.h"
#include "stages/semi_global/energy_volume.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/semi_global/energy_volume_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

#include "stages/semi_global/semi_global_costs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {

using EnergyThread = simd::EnergyVolumeScratch::Thread;

/// One picture's way into the volume.
class EnergyRows {
 public:
  EnergyRows(const SemiGlobal& in, EnergyVolume& out) : in_(in), out_(out), lanes_(out.lanes()) {
    const int n = static_cast<int>(hn::Lanes(D()));
    first_ = (lanes_ - in.max_disparity) / n * n;
    for (int i = 0; i < 256; ++i) p2_more_[i] = static_cast<std::uint8_t>(in.params.p2_at(i) - in.params.p1);
  }

  /// Sums of the paths from the left and from the right.
  void along(EnergyThread& t, int y) const {
    const D d;
    const int n = static_cast<int>(hn::Lanes(d)), w = out_.size().width;
    costs(t, y, 0, w);
    const std::uint8_t* gray = in_.left.value[0].row(y);
    for (const int step : {1, -1}) {
      std::uint8_t *before = t.along.row(0) + kGap, *here = t.along.row(1) + kGap;
      zero(before);
      std::uint8_t least_before = 0;
      for (int i = 0, x = step > 0 ? 0 : w - 1; i < w; ++i, x += step) {
        const int from = i > 0 ? x - step : x;
        const Before path(before, &least_before, &p2_more_[std::abs(gray[x] - gray[from])], in_.params.p1);
        const std::uint8_t* cost = t.costs.row(0) + static_cast<std::ptrdiff_t>(x) * lanes_;
        std::uint8_t* sums = out_.cell(y, x);
        auto lowest = set(255);
        for (int j = first_; j < lanes_; j += n) {
          const auto l = path.step<true>(j, hn::Load(d, cost + j));
          hn::Store(l, d, here + j);
          lowest = hn::Min(lowest, l);
          hn::Store(step > 0 ? l : hn::SaturatedAdd(l, hn::Load(d, sums + j)), d, sums + j);
        }
        least_before = static_cast<std::uint8_t>(first_of(least(d, lowest, lowest)));
        std::swap(before, here);
      }
    }
  }

  /// The path from above and the energies, for columns [begin, end) of one row.
  void down(EnergyThread& t, int y, int begin, int end) const {
    const D d;
    const int n = static_cast<int>(hn::Lanes(d)), apart = lanes_ + kGap;
    costs(t, y, begin, end);
    const std::uint8_t *gray = in_.left.value[0].row(y), *gray_above = in_.left.value[0].row(std::max(y - 1, 0));
    for (int x = begin; x < end; ++x) {
      std::uint8_t *path_costs = t.down.row(0) + kGap + static_cast<std::ptrdiff_t>(x) * apart,
                   *least_path = t.minima.row(0) + x;
      if (y == 0) zero(path_costs), *least_path = 0;
      const Before path(path_costs, least_path, &p2_more_[std::abs(gray[x] - gray_above[x])], in_.params.p1);
      const std::uint8_t* cost = t.costs.row(0) + static_cast<std::ptrdiff_t>(x) * lanes_;
      std::uint8_t *sums = out_.cell(y, x), *here = t.along.row(0) + kGap;
      auto lowest = set(255), lowest_sum = lowest;
      for (int j = first_; j < lanes_; j += n) {
        const auto l = path.step<true>(j, hn::Load(d, cost + j));
        const auto sum = hn::SaturatedAdd(l, hn::Load(d, sums + j));
        hn::Store(l, d, here + j);
        hn::Store(sum, d, sums + j);
        lowest = hn::Min(lowest, l);
        lowest_sum = hn::Min(lowest_sum, sum);
      }
      std::memcpy(path_costs + first_, here + first_, static_cast<std::size_t>(lanes_ - first_));
      const int pair = least(d, lowest, lowest_sum);
      *least_path = static_cast<std::uint8_t>(first_of(pair));
      const auto least_sum = set(second_of(pair)), most_cost = set(EnergyOf::kMostCost), most_paths = set(EnergyOf::kMostPaths),
                 halves = set(0x7F);
      const hn::Repartition<std::uint16_t, D> d16;
      for (int j = first_; j < lanes_; j += n) {
        const auto s = hn::Min(hn::Sub(hn::Load(d, sums + j), least_sum), most_paths);
        const auto half = hn::And(hn::BitCast(d, hn::ShiftRight<1>(hn::BitCast(d16, s))), halves);
        hn::Store(hn::Add(hn::Min(hn::Load(d, cost + j), most_cost), hn::Add(s, half)), d, sums + j);
      }
    }
  }

 private:
  /// What a path begins with; the lane before the first one stays 255.
  void zero(std::uint8_t* path_costs) const { std::memset(path_costs + first_, 0, static_cast<std::size_t>(lanes_ - first_)); }

  /// 255 where a lane holds no disparity.
  void costs(EnergyThread& t, int y, int begin, int end) const {
    RowCosts of_row(in_, y, lanes_);
    for (int x = begin; x < end; x += kBlock) of_row.block(x, std::min(x + kBlock, end), t.costs.row(0));
  }

  const SemiGlobal& in_;
  EnergyVolume& out_;
  int lanes_, first_;          // first: lane of the first vector that holds a disparity
  std::uint8_t p2_more_[256];  // [gray step]: P2 - P1
};

void energies_along(const SemiGlobal& in, EnergyThread& thread, EnergyVolume& out, int begin, int end) {
  const EnergyRows rows(in, out);
  for (int y = begin; y < end; ++y) rows.along(thread, y);
}
void energies_down(const SemiGlobal& in, EnergyThread& thread, EnergyVolume& out, int begin, int end) {
  const EnergyRows rows(in, out);
  for (int y = 0; y < out.size().height; ++y) rows.down(thread, y, begin, end);
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(energies_along);
HWY_EXPORT(energies_down);

namespace simd {

EnergyVolumeScratch::EnergyVolumeScratch(Size size, int max_disparity, int count) {
  constexpr int kGap = SemiGlobalScratch::kGap;
  const int lanes = SemiGlobalScratch::padding(max_disparity);
  for (int i = 0; i < count; ++i) {
    Thread& t = threads.emplace_back();
    t.costs = Image<std::uint8_t>({size.width * lanes, 1});
    t.along = Image<std::uint8_t>({lanes + 2 * kGap, 2});
    t.down = Image<std::uint8_t>({size.width * (lanes + kGap) + kGap, 1});
    t.minima = Image<std::uint8_t>({size.width, 1});
    // The lanes beside a cell are the disparities that there are not.
    for (int row : {0, 1}) std::memset(t.along.row(row), 255, static_cast<std::size_t>(t.along.width()));
    std::memset(t.down.row(0), 255, static_cast<std::size_t>(t.down.width()));
  }
}

void energy_volume(Pool& pool, const SemiGlobal& in, EnergyVolumeScratch& scratch, EnergyVolume& out) {
  DUO_CHECK(out.lanes() == SemiGlobalScratch::padding(in.max_disparity));
  DUO_CHECK(in.left.size() == out.size() && in.max_disparity == out.max_disparity() && in.params.paths() == 3);
  DUO_CHECK(static_cast<int>(scratch.threads.size()) >= pool.threads());
  const auto along = HWY_DYNAMIC_DISPATCH(energies_along);
  const auto down = HWY_DYNAMIC_DISPATCH(energies_down);
  const auto thread = [&](int part) -> EnergyVolumeScratch::Thread& { return scratch.threads[static_cast<std::size_t>(part)]; };
  pool.rows(out.size().height, [&](int begin, int end, int part) { along(in, thread(part), out, begin, end); });
  pool.rows(out.size().width, [&](int begin, int end, int part) { down(in, thread(part), out, begin, end); });
}

}  // namespace simd
}  // namespace duo
#endif
