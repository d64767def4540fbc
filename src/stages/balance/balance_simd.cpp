#include <mutex>

#include "core/check.h"
#include "stages/balance/balance.h"

namespace duo::simd {

// Look-ups by value: the plain rows, in parallel. The order in which parts are added does not change integer sums.
void balance(Pool& pool, const GrayPair& pair, View<std::uint8_t> dst) {
  DUO_CHECK(pair.right.size() == dst.size());
  BrightnessSums left, right;
  std::mutex mutex;
  pool.rows(dst.height(), [&](int begin, int end) {
    const BrightnessSums l = brightness_sums(pair.left, pair.left_inside, begin, end);
    const BrightnessSums r = brightness_sums(pair.right, pair.right_inside, begin, end);
    const std::lock_guard lock(mutex);
    left.add(l);
    right.add(r);
  });
  const auto table = balance_table(left, right);
  pool.rows(dst.height(), [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      const std::uint8_t* src = pair.right.row(y);
      std::uint8_t* out = dst.row(y);
      for (int x = 0; x < dst.width(); ++x) out[x] = table[src[x]];
    }
  });
}

}  // namespace duo::simd
