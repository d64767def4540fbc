// Lanes are pixels along x. Rows of a plane start on 64 bytes and are padded to 64 bytes, so whole vectors are written from
// multiples of the vector's length and read past the end of a row; what the lanes beyond it hold is never used.

#include <algorithm>

#include "stages/sift/functions.h"
#include "stages/sift/histograms_simd.h"
#include "stages/sift/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/sift/sift_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using SiftTag = hn::CappedTag<float, 16>;

// Columns are summed into a stack buffer a chunk of the row at a time, then the buffer along x.
void sift_blur(View<const float> src, const sift::BlurKernel& kernel, View<float> dst, View<float> difference, int begin,
               int end) {
  constexpr int kChunk = 512, kMost = sift::kMostRadius;
  const SiftTag d;
  const int n = static_cast<int>(hn::Lanes(d)), w = src.width(), h = src.height(), radius = kernel.radius;
  HWY_ALIGN_MAX float columns[kMost + kChunk + kMost + 2 * 16];  // columns[kMost + i] belongs to x0 + i
  const float *up[kMost + 1], *down[kMost + 1];
  for (int y = begin; y < end; ++y) {
    for (int i = 0; i <= radius; ++i) {
      up[i] = src.row(std::max(y - i, 0));
      down[i] = src.row(std::min(y + i, h - 1));
    }
    for (int x0 = 0; x0 < w; x0 += kChunk) {
      const int count = std::min(kChunk, w - x0);
      const int first = std::max(-radius, -x0), last = std::min(count + radius, w - x0);
      for (int i = first; i < last; i += n) {
        const int x = x0 + i;
        auto sum = hn::Mul(hn::LoadU(d, up[0] + x), hn::Set(d, kernel.weight[0]));
        for (int k = 1; k <= radius; ++k)
          sum =
              hn::Add(sum, hn::Mul(hn::Add(hn::LoadU(d, up[k] + x), hn::LoadU(d, down[k] + x)), hn::Set(d, kernel.weight[k])));
        hn::StoreU(sum, d, columns + kMost + i);
      }
      std::fill(columns + kMost - radius, columns + kMost + first, columns[kMost + first]);
      std::fill(columns + kMost + last, columns + kMost + count + radius, columns[kMost + last - 1]);

      for (int i = 0; i < count; i += n) {
        const float* at = columns + kMost + i;
        auto sum = hn::Mul(hn::LoadU(d, at), hn::Set(d, kernel.weight[0]));
        for (int k = 1; k <= radius; ++k)
          sum = hn::Add(sum, hn::Mul(hn::Add(hn::LoadU(d, at - k), hn::LoadU(d, at + k)), hn::Set(d, kernel.weight[k])));
        hn::Store(sum, d, dst.row(y) + x0 + i);
        if (!difference.empty()) hn::Store(hn::Sub(sum, hn::Load(d, src.row(y) + x0 + i)), d, difference.row(y) + x0 + i);
      }
    }
  }
}

void sift_mark(const View<const float> (&differences)[3], float threshold, View<std::uint8_t> marks, int x_begin, int x_end,
               int begin, int end) {
  const SiftTag d;
  const int n = static_cast<int>(hn::Lanes(d));
  const auto least = hn::Set(d, threshold);
  for (int y = begin; y < end; ++y) {
    std::uint8_t* out = marks.row(y);
    std::fill(out + x_begin, out + x_end, std::uint8_t{0});
    const float* here = differences[1].row(y);
    for (int x = x_begin; x < x_end; x += n) {
      const auto value = hn::LoadU(d, here + x);
      auto is = hn::And(hn::Gt(hn::Abs(value), least), hn::FirstN(d, static_cast<std::size_t>(x_end - x)));
      // A minimum is a maximum with all signs turned. Most vectors are through after the row itself.
      const auto sign = hn::And(value, hn::SignBit(d));
      const auto height = hn::Xor(value, sign);
      const auto hold = [&](const float* row) HWY_ATTR {
        const auto other = [&](int i) HWY_ATTR { return hn::Xor(hn::LoadU(d, row + x + i), sign); };
        is = hn::And(is, hn::Le(hn::Max(hn::Max(other(-1), other(1)), other(0)), height));
        return !hn::AllFalse(d, is);
      };
      const std::ptrdiff_t stride = differences[1].stride();
      if (!hold(here) || !hold(here - stride) || !hold(here + stride)) continue;
      if (!hold(differences[0].row(y)) || !hold(differences[0].row(y - 1)) || !hold(differences[0].row(y + 1))) continue;
      if (!hold(differences[2].row(y)) || !hold(differences[2].row(y - 1)) || !hold(differences[2].row(y + 1))) continue;
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(d, is, bits);
      for (int i = 0; i < n && x + i < x_end; ++i) out[x + i] = bits[i >> 3] >> (i & 7) & 1;
    }
  }
}

void sift_gradient(View<const float> src, View<float> magnitude, View<float> turns, int begin, int end) {
  const SiftTag d;
  const int n = static_cast<int>(hn::Lanes(d)), w = src.width();
  const auto zero = hn::Zero(d);
  for (int y = begin; y < end; ++y) {
    const float *here = src.row(y), *up = src.row(y - 1), *down = src.row(y + 1);
    for (int x = 0; x < w; x += n) {
      // Column 0 is not used: its left neighbour is the padding of the row above, which exists as y >= 1.
      const auto dx = hn::Sub(hn::LoadU(d, here + x + 1), hn::LoadU(d, here + x - 1));
      const auto dy = hn::Sub(hn::Load(d, down + x), hn::Load(d, up + x));
      hn::Store(hn::Sqrt(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy))), d, magnitude.row(y) + x);

      const auto ax = hn::Abs(dx), ay = hn::Abs(dy);
      const auto z = hn::Div(hn::Min(ax, ay), hn::Max(hn::Max(ax, ay), hn::Set(d, 1e-30f))), zz = hn::Mul(z, z);
      auto sum = hn::Set(d, sift::kAtan[4]);
      for (int i = 3; i >= 0; --i) sum = hn::Add(hn::Set(d, sift::kAtan[i]), hn::Mul(zz, sum));
      auto turn = hn::Mul(z, sum);
      turn = hn::IfThenElse(hn::Gt(ay, ax), hn::Sub(hn::Set(d, 0.25f), turn), turn);
      turn = hn::IfThenElse(hn::Lt(dx, zero), hn::Sub(hn::Set(d, 0.5f), turn), turn);
      turn = hn::IfThenElse(hn::Lt(dy, zero), hn::Sub(hn::Set(d, 1.0f), turn), turn);
      hn::Store(turn, d, turns.row(y) + x);
    }
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(sift_blur);
HWY_EXPORT(sift_mark);
HWY_EXPORT(sift_gradient);

namespace simd {

void sift(Pool& pool, View<const std::uint8_t> src, const Window& window, const SiftParams& params, SiftScratch& scratch,
          SiftPoints& out) {
  const sift::Kernels kernels = {HWY_DYNAMIC_DISPATCH(sift_blur), HWY_DYNAMIC_DISPATCH(sift_mark),
                                 HWY_DYNAMIC_DISPATCH(sift_gradient), sift::directions_simd(), sift::cells_simd()};
  sift::run(kernels, pool, src, window, params, scratch, out);
}

}  // namespace simd
}  // namespace duo
#endif
