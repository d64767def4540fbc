#include "pipeline/picture_watch.h"

#include "pipeline/black_bars.h"

namespace duo {

void PictureWatch::see(const Pair& pair) {
  if (!bars_) bars_ = black_bars(pair);
  repeats_.see(pair);
  offset_.see(pair.left.t_ns, repeats_.motion());
}

std::string PictureWatch::warning(bool live) const {
  if (live) return repeats_.warning(true);
  // Where one video began later, what rests in it while the other moves looks like a camera that hangs.
  const std::string bars = bars_.value_or(""), offset = offset_.warning(),
                    when = offset.empty() ? repeats_.warning(false) : offset;
  return bars + (bars.empty() || when.empty() ? "" : "; ") + when;
}

}  // namespace duo
