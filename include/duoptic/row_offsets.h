// Rows of a pair that is taken as rectified and is not quite: found in the scene itself, put right before matching.
#pragma once

#include <array>
#include <optional>

#include "duoptic/frame.h"
#include "duoptic/result.h"
#include "duoptic/source.h"

namespace [[gnu::visibility("default")]] duo {

/// How a right picture that was undistorted as another lens lies to the right one: a turn of the camera, a focal length and a
/// lens around its own middle. Rows tell all of it that moves rows, and it moves columns as well: x_right = (1 + zoom) x' -
/// roll y' + pan x' x' + tilt x' y', y_right = (1 + zoom) y' + roll x' + pan x' y' + tilt y' y' + down, where
/// (x', y') = (x, y) + ((x, y) - middle) (bend2 r^2 + bend4 r^4). What moves all columns alike is not in the rows, and stays.
///
/// Units   half the picture's width, from the picture's middle; r from `middle`
struct LensLeftOver {
  double down = 0, roll = 0, zoom = 0, pan = 0, tilt = 0, bend2 = 0, bend4 = 0, middle_x = 0, middle_y = 0;
  double reach = 0;       // r as far as the points show it; further out nothing is known
  double columns_px = 0;  // by how much columns of the outer points are off
};

/// How much lower each thing lies in the right picture than in the left one: a smooth map over the right picture.
///
/// Units   px; u and v run from -1 to 1 over the right picture's width and height; r is the distance from its middle, 1 at its
///         left and right sides
struct RowOffsets {
  Size size;
  std::array<double, 7> terms_px{};       // of 1, u, v, u u, u v, v v, v r r: of what is left of a lens
  double least_px = 0, most_px = 0;       // what the points show: the map does not go beyond
  int points = 0;                         // that agree with it
  double before_px = 0, after_px = 0;     // median |row difference| of these points as they are, and with the map taken off
  std::optional<LensLeftOver> lens = {};  // explains the rows as well, and tells of columns: taken in place of the terms

  /// By the terms, also where there is a lens.
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
