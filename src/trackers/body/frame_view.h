// What a frame offers to the trackers of people.
#pragma once

#include "duoptic/detector.h"
#include "duoptic/image.h"
#include "trackers/body/lift.h"

namespace duo::body {

struct FrameView {
  DepthView depth;
  View<const Rgb8> picture;
  double frame_s = 1.0 / 30;
  BodyModel model = BodyModel::kLite;  // that marked the points
  View<const std::uint8_t> covered;    // not 0: somebody nearer was taken out there; empty: nobody was

  bool is_covered(Vec2 at_px) const {
    const int x = static_cast<int>(at_px.x + 0.5), y = static_cast<int>(at_px.y + 0.5);
    return at_px.x >= 0 && at_px.y >= 0 && x < covered.width() && y < covered.height() && covered.at(y, x) != 0;
  }
};

}  // namespace duo::body
