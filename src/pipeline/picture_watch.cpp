#include "pipeline/picture_watch.h"

#include <bit>

#include "pipeline/black_bars.h"

namespace duo {

void PictureWatch::see(const Pair& pair, bool live) {
  repeats_.see(pair);
  if (live) return;
  offset_.see(pair.left.t_ns, repeats_.motion(), repeats_.least_motion());
  // Pairs 1, 2, 4, 8 and so on: a title has bars, and what follows has none.
  if (std::has_single_bit(++seen_) && bars_ != "")
    if (auto bars = black_bars(pair)) bars_ = std::move(bars);
}

std::string PictureWatch::warning(bool live) const {
  if (live) return repeats_.warning(true);
  // Where one video began later, what rests in it while the other moves looks like a camera that hangs.
  const std::string bars = bars_.value_or(""), offset = offset_.warning(),
                    when = offset.empty() ? repeats_.warning(false) : offset;
  return bars + (bars.empty() || when.empty() ? "" : "; ") + when;
}

}  // namespace duo
