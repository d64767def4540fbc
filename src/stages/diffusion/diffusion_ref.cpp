#include <algorithm>
#include <cstdlib>
#include <utility>

#include "core/check.h"
#include "stages/diffusion/diffusion.h"

namespace duo::ref {
namespace {

int flow(int difference) {
  const int step = std::abs(difference) >> (Diffusion::kBits + 1);
  if (step >= 16) return 0;
  return (difference * (Diffusion::kConductance[static_cast<std::size_t>(step)] << 7) + (1 << 14)) >> 15;
}

}  // namespace

void diffuse(View<const std::uint8_t> src, View<std::uint8_t> dst) {
  DUO_CHECK(src.size() == dst.size());
  const int w = src.width(), h = src.height();
  Image<std::int16_t> now(src.size()), next(src.size());
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) now.at(y, x) = static_cast<std::int16_t>(src.at(y, x) << Diffusion::kBits);
  for (int sweep = 0; sweep < Diffusion::kSweeps; ++sweep) {
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        const int v = now.at(y, x);
        int sum = 0;
        for (const auto& [dy, dx] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}})
          sum += flow(now.at(std::clamp(y + dy, 0, h - 1), std::clamp(x + dx, 0, w - 1)) - v);
        next.at(y, x) = static_cast<std::int16_t>(v + ((sum + 2) >> 2));
      }
    now.swap(next);
  }
  constexpr int kHalf = 1 << (Diffusion::kBits - 1);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      dst.at(y, x) = static_cast<std::uint8_t>(std::clamp((now.at(y, x) + kHalf) >> Diffusion::kBits, 0, 255));
}

}  // namespace duo::ref
