// A right picture that was undistorted as another lens: found in rows, put right in rows and columns.
#pragma once

#include <optional>
#include <vector>

#include "calib/scene_matches.h"
#include "duoptic/row_offsets.h"

namespace duo {

/// The lens that explains the rows of most matches, where it is there beyond doubt: it moves columns of the outer points by a
/// pixel at least, and how much is known to a fifth.
///
/// Source  Gauss-Newton with Cauchy's weights, whose scale shrinks from 1/480 of the width to half a pixel, and Gaussian priors
std::optional<LensLeftOver> fit_lens_left_over(const SceneMatches& scene);

/// How much lower each match lies in the right picture once the lens is put right.
std::vector<double> lens_row_errors_px(const LensLeftOver& lens, const SceneMatches& scene);

/// Where each pixel of the picture that is put right lies in the right picture; NaN where nothing is known.
class LensPlaces {
 public:
  explicit LensPlaces(const RowOffsets& rows);
  /// Quick where the last call was for a neighbour.
  Vec2 at(int x, int y);

 private:
  std::optional<Vec2> solve(Vec2 want, Vec2 at) const;

  LensLeftOver lens_;
  Size size_;
  double farthest_ = 0;  // from the lens's middle, of what is known
  std::optional<Vec2> last_;
};

}  // namespace duo
