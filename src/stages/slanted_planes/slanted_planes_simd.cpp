// Lanes are pixels of a row. The weights of a stretch of pixels are worked out once for all planes that these try. Both
// energies that a tap's disparity lies between come with one gather. Taps begin with the rows next to the pixel: a plane that
// is worse by then than the best one, in all lanes, is given up.

#include <algorithm>
#include <cstring>
#include <utility>

#include "core/check.h"
#include "stages/slanted_planes/slanted_planes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/slanted_planes/slanted_planes_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

#ifndef DUO_SLANTED_PLANES_ONCE
#define DUO_SLANTED_PLANES_ONCE
namespace duo {
constexpr int kStretch = 64;                                                       // pixels whose weights are kept
constexpr int kGuideBefore = 32, kGuideAfter = kStretch + SlantedPlanes::kRadius;  // columns around the guide
constexpr int kTapsAlong = 2 * SlantedPlanes::kRadius / SlantedPlanes::kStep + 1;
static_assert(EnergyVolume::kBefore >= SlantedPlanes::kRadius);
static_assert(EnergyVolume::kAfter >= SlantedPlanes::kRadius + 16, "the last vector of a row");
}  // namespace duo
#endif

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Planes of a stretch, or what they cost.
struct StretchOfPlanes {
  HWY_ALIGN_MAX std::int32_t d[kStretch], dx[kStretch], dy[kStretch], energy[kStretch];
  void set(int i, const Plane& plane) { d[i] = plane.d, dx[i] = plane.dx, dy[i] = plane.dy; }
  Plane at(int i) const { return {d[i], dx[i], dy[i]}; }
};

class Settling {
 public:
  Settling(const SlantedPlanes& in, const simd::SlantedPlanesScratch& scratch) : in_(in), s_(scratch), size_(in.guide.size()) {}

  void row(const PlaneMap& before, int y, int sweep, PlaneMap& after) {
    for (int x = 0; x < size_.width; x += kStretch) stretch(before, y, x, std::min(kStretch, size_.width - x), sweep, after);
  }

 private:
  using DI = hn::CappedTag<std::int32_t, 16>;

  void stretch(const PlaneMap& before, int y, int x0, int count, int sweep, PlaneMap& after) {
    weigh(y, x0);
    // Lanes beyond the row follow its last pixel.
    for (int i = 0; i < kStretch; ++i) best_.set(i, before.at(y, x0 + std::min(i, count - 1)));
    std::fill_n(best_.energy, kStretch, 0x7FFFFFFF);
    energies(y, x0, count, best_, best_.energy);
    const int offset = SlantedPlanes::kOffsets[static_cast<std::size_t>(sweep)];
    for (const auto& [dy, dx] : {std::pair{0, -offset}, {0, offset}, {-offset, 0}, {offset, 0}}) {
      if (y + dy < 0 || y + dy >= size_.height) continue;
      for (int i = 0; i < count; ++i) {
        const int x = x0 + i;
        tried_.set(i, x + dx < 0 || x + dx >= size_.width ? best_.at(i) : plane_of_neighbour(before, y, x, dy, dx));
      }
      attempt(y, x0, count);
    }
    for (int k = 0; k < SlantedPlanes::kRandom; ++k) {
      for (int i = 0; i < count; ++i) tried_.set(i, plane_nearby(best_.at(i), y, x0 + i, sweep, k));
      attempt(y, x0, count);
    }
    for (int i = 0; i < count; ++i) after.set(y, x0 + i, best_.at(i));
  }

  void attempt(int y, int x0, int count) {
    const int last = (in_.energies.max_disparity() - 1) << Plane::kBits;
    for (int i = 0; i < kStretch; ++i)
      if (i >= count || tried_.d[i] < 0 || tried_.d[i] > last) tried_.set(i, best_.at(i));  // never better
    energies(y, x0, count, tried_, tried_.energy);
    for (int i = 0; i < count; ++i)
      if (tried_.energy[i] < best_.energy[i]) best_.set(i, tried_.at(i)), best_.energy[i] = tried_.energy[i];
  }

  /// The weights of all taps that lie in the picture's rows.
  void weigh(int y, int x0) {
    const hn::CappedTag<std::uint8_t, kStretch> d;
    const hn::Repartition<std::uint16_t, decltype(d)> d16;
    const auto table = hn::LoadDup128(d, SlantedPlanes::kWeights.data());
    const auto limit = hn::Set(d, 64), entries = hn::Set(d, 15);
    std::uint8_t* out = weights_;
    for (int ty = y - SlantedPlanes::kRadius; ty <= y + SlantedPlanes::kRadius; ty += SlantedPlanes::kStep) {
      if (ty < 0 || ty >= size_.height) {
        out += kTapsAlong * kStretch;
        continue;
      }
      for (int tx = -SlantedPlanes::kRadius; tx <= SlantedPlanes::kRadius; tx += SlantedPlanes::kStep, out += kStretch)
        for (int i = 0; i < kStretch; i += static_cast<int>(hn::Lanes(d))) {
          const int x = kGuideBefore + x0 + i;
          auto step = hn::LoadU(d, s_.outside.row(ty) + x + tx);
          for (const Image<std::uint8_t>& plane : s_.guide) {
            const auto a = hn::LoadU(d, plane.row(y) + x), b = hn::LoadU(d, plane.row(ty) + x + tx);
            step = hn::SaturatedAdd(step, hn::Sub(hn::Max(a, b), hn::Min(a, b)));
          }
          const auto entry = hn::And(hn::BitCast(d, hn::ShiftRight<2>(hn::BitCast(d16, step))), entries);
          hn::Store(hn::IfThenElseZero(hn::Lt(step, limit), hn::TableLookupBytes(table, entry)), d, out + i);
        }
    }
  }

  /// Of each pixel's plane; any number from the best one's energy on where it is no less than that.
  void energies(int y, int x0, int count, const StretchOfPlanes& planes, std::int32_t* out) const {
    const DI d;
    const hn::Rebind<std::uint8_t, DI> d8;
    const hn::Repartition<std::int16_t, DI> d16;
    constexpr int kRadius = SlantedPlanes::kRadius, kStep = SlantedPlanes::kStep;
    const int stride = in_.energies.stride();
    const auto last = hn::Set(d, (in_.energies.max_disparity() - 1) << Plane::kBits), byte = hn::Set(d, 255),
               sixteenth = hn::Set(d, 15), cells = hn::Mul(hn::Iota(d, 0), hn::Set(d, stride));
    for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
      const auto dx = hn::Load(d, planes.dx + i), dy = hn::Load(d, planes.dy + i), least = hn::Load(d, best_.energy + i);
      const auto at_left = hn::Sub(hn::Load(d, planes.d + i), hn::Mul(dx, hn::Set(d, kRadius)));
      const auto along = hn::Mul(dx, hn::Set(d, kStep));
      auto sum = hn::Zero(d);
      for (int k = 0; k < kTapsAlong; ++k) {
        const int j = (k % 2 != 0 ? -(k + 1) / 2 : k / 2) * kStep;  // 0, -2, 2, -4 ..
        if (y + j < 0 || y + j >= size_.height) continue;
        const std::uint8_t* weight = weights_ + (j + kRadius) / kStep * kTapsAlong * kStretch + i;
        // The byte of the next disparity comes first; one lane further is the lower one's.
        const std::uint8_t* cell = in_.energies.cell(y + j, x0 + i - kRadius) + in_.energies.lanes() - 2;
        auto at_tap = hn::Add(at_left, hn::Mul(dy, hn::Set(d, j)));
        for (int t = 0; t < kTapsAlong; ++t, weight += kStretch, cell += kStep * stride) {
          const auto held = hn::Min(hn::Max(at_tap, hn::Zero(d)), last);
          const auto both = hn::GatherOffset(d, reinterpret_cast<const std::int32_t*>(cell),
                                             hn::Sub(cells, hn::ShiftRight<Plane::kBits>(held)));
          const auto higher = hn::BitCast(d16, hn::And(both, byte)),
                     lower = hn::BitCast(d16, hn::And(hn::ShiftRight<8>(both), byte)),
                     share = hn::BitCast(d16, hn::And(hn::ShiftRight<Plane::kBits - 4>(held), sixteenth));
          const auto energy = hn::Add(hn::ShiftLeft<4>(lower), hn::Mul(hn::Sub(higher, lower), share));
          sum = hn::Add(sum, hn::Mul(hn::BitCast(d, energy), hn::PromoteTo(d, hn::LoadU(d8, weight))));
          at_tap = hn::Add(at_tap, along);
        }
        if (hn::AllFalse(d, hn::Lt(sum, least))) break;
      }
      hn::Store(sum, d, out + i);
    }
  }

  const SlantedPlanes& in_;
  const simd::SlantedPlanesScratch& s_;
  Size size_;
  StretchOfPlanes best_, tried_;
  HWY_ALIGN_MAX std::uint8_t weights_[kTapsAlong * kTapsAlong * kStretch];
};

void settle_rows(const SlantedPlanes& in, const simd::SlantedPlanesScratch& scratch, const PlaneMap& before, int sweep,
                 int begin, int end, PlaneMap& after) {
  Settling settling(in, scratch);
  for (int y = begin; y < end; ++y) settling.row(before, y, sweep, after);
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(settle_rows);

namespace simd {

SlantedPlanesScratch::SlantedPlanesScratch(Size size) : next(size) {
  const Size padded{kGuideBefore + size.width + kGuideAfter, size.height};
  for (Image<std::uint8_t>& plane : guide) plane = Image<std::uint8_t>(padded);
  outside = Image<std::uint8_t>(padded);
  for (int y = 0; y < size.height; ++y) {
    std::memset(outside.row(y), 255, static_cast<std::size_t>(padded.width));
    std::memset(outside.row(y) + kGuideBefore, 0, static_cast<std::size_t>(size.width));
  }
}

void slanted_planes(Pool& pool, const SlantedPlanes& in, SlantedPlanesScratch& scratch, PlaneMap& planes) {
  const Size size = in.guide.size();
  DUO_CHECK(size == in.energies.size() && planes.size() == size && scratch.next.size() == size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const Rgb8 v = in.guide.at(y, x);
      const std::uint8_t values[3] = {v.r, v.g, v.b};
      for (std::size_t c = 0; c < 3; ++c) scratch.guide[c].at(y, kGuideBefore + x) = values[c];
    }
  const auto settle = HWY_DYNAMIC_DISPATCH(settle_rows);
  for (int sweep = 0; sweep < SlantedPlanes::kSweeps; ++sweep) {
    pool.rows(size.height, [&](int begin, int end) { settle(in, scratch, planes, sweep, begin, end, scratch.next); });
    std::swap(planes, scratch.next);
  }
}

}  // namespace simd
}  // namespace duo
#endif
