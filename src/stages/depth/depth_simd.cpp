#include "core/check.h"
#include "stages/depth/depth.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/depth/depth_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void depth_rows(View<const std::uint16_t> d_q4, float focal_baseline_px_mm, View<std::uint16_t> depth_mm, int y_begin, int y_end) {
  const hn::ScalableTag<float> df;
  const hn::RebindToSigned<decltype(df)> di;
  const hn::Rebind<std::uint16_t, decltype(df)> d16;
  const int n = static_cast<int>(hn::Lanes(df)), w = d_q4.width();
  const float numerator = focal_baseline_px_mm * 16.0F;
  const auto top = hn::Set(df, numerator), half = hn::Set(df, 0.5F), limit = hn::Set(df, 65536.0F);
  const auto none = hn::Set(di, Disparity::kNone);
  for (int y = y_begin; y < y_end; ++y) {
    const std::uint16_t* in = d_q4.row(y);
    std::uint16_t* out = depth_mm.row(y);
    int x = 0;
    for (; x + n <= w; x += n) {
      const auto d = hn::PromoteTo(di, hn::LoadU(d16, in + x));
      const auto z = hn::Add(hn::Div(top, hn::ConvertTo(df, d)), half);
      const auto known = hn::And(hn::MaskFromVec(hn::BitCast(di, hn::VecFromMask(df, hn::Lt(z, limit)))), hn::Ne(d, none));
      // d = 0 gave infinity, which is not below the limit.
      hn::StoreU(hn::DemoteTo(d16, hn::IfThenElseZero(known, hn::ConvertTo(di, z))), d16, out + x);
    }
    for (; x < w; ++x) {
      const float z = in[x] == 0 || in[x] == Disparity::kNone ? 65536.0F : numerator / static_cast<float>(in[x]) + 0.5F;
      out[x] = z < 65536.0F ? static_cast<std::uint16_t>(z) : std::uint16_t{0};
    }
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(depth_rows);

namespace simd {

void depth(Pool& pool, View<const std::uint16_t> d_q4, float focal_baseline_px_mm, View<std::uint16_t> depth_mm) {
  DUO_CHECK(d_q4.size() == depth_mm.size());
  const auto rows = HWY_DYNAMIC_DISPATCH(depth_rows);
  pool.rows(d_q4.height(), [&](int begin, int end) { rows(d_q4, focal_baseline_px_mm, depth_mm, begin, end); });
}

}  // namespace simd
}  // namespace duo
#endif
