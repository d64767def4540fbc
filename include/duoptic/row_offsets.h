// Rows of a pair that is taken as rectified and is not quite: found in the scene itself, put right before matching.
#pragma once

#include <array>

#include "duoptic/frame.h"
#include "duoptic/result.h"
#include "duoptic/source.h"

namespace duo {

/// How much lower each thing lies in the right picture than in the left one: a smooth map over the right picture.
///
/// Units   px; u and v run from -1 to 1 over the right picture's width and height; r is the distance from its middle, 1 at its
///         left and right sides
struct RowOffsets {
  Size size;
  std::array<double, 7> terms_px{};    // of 1, u, v, u u, u v, v v, v r r: of what is left of a lens
  double least_px = 0, most_px = 0;    // what the points show: the map does not go beyond
  int points = 0;                      // that agree with it
  double before_px = 0, after_px = 0;  // median |row difference| of these points as they are, and with the map taken off

  double at(double x_px, double y_px) const;
  /// Enough points agree, and rows gain by it more than resampling costs.
  bool matter() const;
};

/// From SIFT points of pairs spread over the first ten seconds of a stream, of which some may be matched wrongly: a robust fit,
/// held near a plain offset where points are few or lie together.
///
/// Errors  those of the stream; a scene that shows too little gives no points and no offsets
/// Source  iteratively reweighted least squares with Cauchy's weights (Holland, Welsch, 1977) and Gaussian priors
Result<RowOffsets> find_row_offsets(PairSource& pairs, int threads);
RowOffsets find_row_offsets(const Pair& pair, int threads);

}  // namespace duo
