#include <algorithm>

#include "core/check.h"
#include "stages/diffusion/diffusion.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/diffusion/diffusion_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

#ifndef DUO_DIFFUSION_ONCE
#define DUO_DIFFUSION_ONCE
namespace duo {
constexpr int kDiffusionBefore = 32;               // columns before a row; its vectors begin aligned
constexpr int kDiffusionAfter = kDiffusionBefore;  // and the last vector of it
}  // namespace duo
#endif

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// What flows for a difference.
template <class V>
HWY_INLINE V diffusion_flow(V neighbour, V v) {
  const hn::CappedTag<std::int16_t, 32> d;
  const hn::Repartition<std::uint8_t, decltype(d)> d8;
  const auto difference = hn::Sub(neighbour, v), size = hn::Abs(difference);
  // An index with its high bit set looks up 0; so does the empty high byte.
  const auto step = hn::Min(hn::ShiftRight<Diffusion::kBits + 1>(size), hn::Set(d, 16));
  const auto index =
      hn::And(hn::Add(step, hn::Set(d, static_cast<std::int16_t>(0x8070))), hn::Set(d, static_cast<std::int16_t>(0x808F)));
  const auto table = hn::LoadDup128(d8, Diffusion::kConductance.data());
  const auto conductance = hn::BitCast(d, hn::TableLookupBytesOr0(table, hn::BitCast(d8, index)));
  return hn::MulFixedPoint15(difference, hn::ShiftLeft<7>(conductance));
}

/// One row of a sweep; columns beside it are read.
void diffuse_row(const std::int16_t* above, const std::int16_t* here, const std::int16_t* below, int w, std::int16_t* out) {
  const hn::CappedTag<std::int16_t, 32> d;
  for (int x = 0; x < w; x += static_cast<int>(hn::Lanes(d))) {
    const auto v = hn::LoadU(d, here + x);
    const auto along_y = hn::Add(diffusion_flow(hn::LoadU(d, above + x), v), diffusion_flow(hn::LoadU(d, below + x), v));
    const auto along_x = hn::Add(diffusion_flow(hn::LoadU(d, here + x - 1), v), diffusion_flow(hn::LoadU(d, here + x + 1), v));
    hn::StoreU(hn::Add(v, hn::ShiftRight<2>(hn::Add(hn::Add(along_y, along_x), hn::Set(d, 2)))), d, out + x);
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(diffuse_row);

namespace simd {

DiffusionScratch::DiffusionScratch(Size size)
    : now({kDiffusionBefore + size.width + kDiffusionAfter, size.height}), next(now.size()) {}

void diffuse(Pool& pool, View<const std::uint8_t> src, DiffusionScratch& scratch, View<std::uint8_t> dst) {
  const int w = src.width(), h = src.height();
  DUO_CHECK(src.size() == dst.size());
  DUO_CHECK(scratch.now.size() == (Size{kDiffusionBefore + w + kDiffusionAfter, h}));
  const auto row = [](Image<std::int16_t>& image, int y) { return image.row(y) + kDiffusionBefore; };
  const auto continue_row = [&](std::int16_t* values) { values[-1] = values[0], values[w] = values[w - 1]; };
  pool.rows(h, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      std::int16_t* values = row(scratch.now, y);
      for (int x = 0; x < w; ++x) values[x] = static_cast<std::int16_t>(src.at(y, x) << Diffusion::kBits);
      continue_row(values);
    }
  });
  const auto here = HWY_DYNAMIC_DISPATCH(diffuse_row);
  for (int sweep = 0; sweep < Diffusion::kSweeps; ++sweep) {
    pool.rows(h, [&](int begin, int end) {
      for (int y = begin; y < end; ++y) {
        std::int16_t* out = row(scratch.next, y);
        here(row(scratch.now, std::max(y - 1, 0)), row(scratch.now, y), row(scratch.now, std::min(y + 1, h - 1)), w, out);
        continue_row(out);
      }
    });
    scratch.now.swap(scratch.next);
  }
  constexpr int kHalf = 1 << (Diffusion::kBits - 1);
  pool.rows(h, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < w; ++x)
        dst.at(y, x) = static_cast<std::uint8_t>(std::clamp((row(scratch.now, y)[x] + kHalf) >> Diffusion::kBits, 0, 255));
  });
}

}  // namespace simd
}  // namespace duo
#endif
