#include "core/check.h"
#include "stages/gray/gray.h"

namespace duo::ref {

void gray(View<const Rgb8> src, View<std::uint8_t> dst) {
  DUO_CHECK(src.size() == dst.size());
  for (int y = 0; y < dst.height(); ++y)
    for (int x = 0; x < dst.width(); ++x) {
      const Rgb8 p = src.at(y, x);
      dst.at(y, x) = static_cast<std::uint8_t>((77 * p.r + 150 * p.g + 29 * p.b + 128) >> 8);
    }
}

}  // namespace duo::ref
