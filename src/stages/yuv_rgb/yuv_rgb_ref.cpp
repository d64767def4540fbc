#include <algorithm>

#include "core/check.h"
#include "stages/yuv_rgb/yuv_rgb.h"

namespace duo::ref {

void yuv_rgb(const YuvPlanes& src, const YuvWeights& weights, View<Rgb8> dst) {
  DUO_CHECK(src.well_shaped() && src.y.size() == dst.size());
  const int last = src.u.width() - 1;
  for (int y = 0; y < dst.height(); ++y) {
    const ChromaRows rows = chroma_rows(src, y);
    for (int x = 0; x < dst.width(); ++x) {
      const int near = x / 2, far = std::clamp(x % 2 == 0 ? near - 1 : near + 1, 0, last);
      const auto chroma = [&](View<const std::uint8_t> c) {
        return 3 * (c.at(rows.first, near) + c.at(rows.second, near)) + c.at(rows.first, far) + c.at(rows.second, far) -
               8 * 128;
      };
      const int u = chroma(src.u), v = chroma(src.v), luma = src.y.at(y, x);
      const auto color = [&](int added) {
        return static_cast<std::uint8_t>(std::clamp(luma + ((added + 32768) >> 16), 0, 255));
      };
      dst.at(y, x) = {color(v * weights.red_of_v), color(u * weights.green_of_u + v * weights.green_of_v),
                      color(u * weights.blue_of_u)};
    }
  }
}

}  // namespace duo::ref
