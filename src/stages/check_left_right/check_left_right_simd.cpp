#include "stages/check_left_right/check_left_right.h"

namespace duo::simd {
namespace {

CheckLeftRight rows_of(const CheckLeftRight& in, int begin, Size part) {
  CheckLeftRight out = in;
  out.left = in.left.crop(begin, 0, part);
  out.right = in.right.crop(begin, 0, part);
  if (!in.left_inside.empty()) {
    out.left_inside = in.left_inside.crop(begin, 0, part);
    out.right_inside = in.right_inside.crop(begin, 0, part);
  }
  return out;
}

}  // namespace

// Each pixel looks up another by its own value: the plain rows, in parallel.
void check_winners(Pool& pool, const CheckLeftRight& in, View<std::int16_t> dst) {
  pool.rows(dst.height(), [&](int begin, int end) {
    const Size part{dst.width(), end - begin};
    ref::check_winners(rows_of(in, begin, part), dst.crop(begin, 0, part));
  });
}

void check_left_right(Pool& pool, const CheckLeftRight& in, View<const std::uint16_t> fine, View<std::uint16_t> dst) {
  pool.rows(dst.height(), [&](int begin, int end) {
    const Size part{dst.width(), end - begin};
    ref::check_left_right(rows_of(in, begin, part), fine.crop(begin, 0, part), dst.crop(begin, 0, part));
  });
}

}  // namespace duo::simd
