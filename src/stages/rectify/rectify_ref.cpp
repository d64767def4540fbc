#include <algorithm>

#include "core/check.h"
#include "stages/rectify/rectify.h"

namespace duo::ref {

void rectify(View<const std::uint8_t> src, const ResampleMap& map, View<std::uint8_t> dst, View<std::uint8_t> inside) {
  DUO_CHECK(dst.size() == map.corner.size() && inside.size() == dst.size());
  for (int y = 0; y < dst.height(); ++y)
    for (int x = 0; x < dst.width(); ++x) {
      const std::uint32_t corner = map.corner.at(y, x);
      if (corner == ResampleMap::kOutside) {
        dst.at(y, x) = 0;
        inside.at(y, x) = 0;
        continue;
      }
      const int x0 = static_cast<int>(corner >> 16), y0 = static_cast<int>(corner & 0xFFFF);
      const std::uint32_t fx = map.fraction_q8.at(y, x) >> 8, fy = map.fraction_q8.at(y, x) & 0xFF;
      inside.at(y, x) = 255;
      if (map.columns != ResampleMap::Columns::kLinear) {
        const bool cubic = map.columns == ResampleMap::Columns::kCubic;
        const auto weights = cubic ? cubic_weights(static_cast<int>(fy)) : soft_weights(static_cast<int>(fy));
        int sum = 0;
        for (int k = 0; k < 4; ++k) {
          const std::uint8_t* row = src.row(std::clamp(y0 + k - 1, 0, src.height() - 1)) + x0;
          sum += weights[static_cast<std::size_t>(k)] * static_cast<int>(row[0] * (256 - fx) + row[1] * fx);
        }
        dst.at(y, x) = static_cast<std::uint8_t>(std::clamp((sum + 32768) >> 16, 0, 255));
        continue;
      }
      const std::uint32_t top = src.at(y0, x0) * (256 - fx) + src.at(y0, x0 + 1) * fx;
      const std::uint32_t bottom = src.at(y0 + 1, x0) * (256 - fx) + src.at(y0 + 1, x0 + 1) * fx;
      dst.at(y, x) = static_cast<std::uint8_t>((top * (256 - fy) + bottom * fy + 32768) >> 16);
    }
}

}  // namespace duo::ref
