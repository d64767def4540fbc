#include "core/check.h"
#include "stages/depth/depth.h"

namespace duo::ref {

void depth(View<const std::uint16_t> d_q4, float focal_baseline_px_mm, View<std::uint16_t> depth_mm) {
  DUO_CHECK(d_q4.size() == depth_mm.size());
  const float numerator = focal_baseline_px_mm * 16.0F;
  for (int y = 0; y < d_q4.height(); ++y)
    for (int x = 0; x < d_q4.width(); ++x) {
      const std::uint16_t d = d_q4.at(y, x);
      std::uint16_t mm = 0;
      if (d != Disparity::kNone && d != 0)
        if (const float z = numerator / static_cast<float>(d) + 0.5F; z < 65536.0F) mm = static_cast<std::uint16_t>(z);
      depth_mm.at(y, x) = mm;
    }
}

}  // namespace duo::ref
