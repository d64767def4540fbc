// The planes of two gray views, as semi-global matching compares them.
#pragma once

#include "stages/match_planes/match_planes.h"
#include "stages/semi_global/semi_global.h"

namespace duo::test {

struct Views {
  PlaneImages left, right;
  Views(View<const std::uint8_t> l, View<const std::uint8_t> r, View<const std::uint8_t> inside, int max_disparity)
      : left(l.size(), PlaneImages::kPadRight), right(l.size(), simd::SemiGlobalScratch::padding(max_disparity)) {
    ref::match_planes(l, inside, 0, false, left);
    ref::match_planes(r, inside, 0, false, right);
  }
  SemiGlobal in(int max_disparity, const SemiGlobalParams& params) const {
    return {left.planes(), right.planes(), max_disparity, params};
  }
  /// Of views of one row: no gradients, no intervals.
  void keep_gray_alone() {
    for (PlaneImages* view : {&left, &right})
      for (std::size_t c = 0; c < 3; ++c) {
        const View<std::uint8_t> value = view->value[c];
        for (int x = 0; x < value.width(); ++x) {
          if (c > 0) value.at(0, x) = 0;
          view->low[c].at(0, x) = view->high[c].at(0, x) = value.at(0, x);
        }
      }
  }
};

}  // namespace duo::test
