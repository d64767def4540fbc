// The person detector's results as people.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/tensor.h"
#include "duoptic/detector.h"
#include "nets/net.h"

namespace duo {

inline constexpr int kDetectorSide = 224;

/// One scale of the detector: a grid of places with several anchors each.
///
/// Shape  scores n x n x anchors, boxes n x n x 12 anchors: middle, size, hips, size point and two more, in px of the crop, the
///        middle and the points from the anchor
struct DetectorGrid {
  ConstTensor16 scores, boxes;
  int scores_exponent = 0, boxes_exponent = 0;
};

/// People from the detector's grids, best first; each once.
///
/// Source  Bazarevsky et al., "BlazeFace", 2019: anchors, and boxes that overlap by more than 0.3 become their mean, weighted
///         by their scores, instead of the best; "BlazePose", 2020: the hips' middle and a point of the circle around the
///         person. In integers, thresholds on the scores before the sigmoid
class FindPeople {
 public:
  FindPeople();
  std::span<const FoundPerson> operator()(std::span<const DetectorGrid> grids, const TurnedSquare& crop);

 private:
  /// Units  1/256 px of the crop
  struct Candidate {
    std::int32_t score_q15 = 0, order = 0;
    std::int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    std::array<std::int32_t, 4> points = {};  // hips x, y, size point x, y
  };
  void collect(const DetectorGrid& grid);

  std::vector<Candidate> candidates_;
  std::vector<FoundPerson> found_;
};

}  // namespace duo
