// Patches that both cameras see in the mean of many pairs: of bare walls, which have no points.
#pragma once

#include <cstdint>
#include <vector>

#include "calib/scene_matches.h"
#include "duoptic/rig.h"

namespace duo {

/// Sums the pairs of cameras that stand still. Noise goes with the square root of their number, and what a wall has of
/// texture, half a gray level, stays.
///
/// Units  of the gray pictures, in squares of pixels so that at most 480 columns are left
class PairSum {
 public:
  explicit PairSum(Size size);
  void add(const Pair& pair);
  int pairs() const { return pairs_; }
  Size size() const { return size_; }

 private:
  friend SceneMatches match_patches(const Rig& rig, const PairSum& sum);
  Size size_;
  int square_px_ = 1, pairs_ = 0;
  Image<std::uint8_t> gray_;
  Image<std::uint32_t> left_, right_;
};

/// Patches on a grid over the left picture, each where it looks most alike in the right one along the row that the rig says,
/// up to three of the sum's pixels above or below it, and nowhere else on it nearly as much; laid over each other there.
///
/// Each is known to a few tenths of a pixel, where points are to a few hundredths; but they lie all over the picture.
SceneMatches match_patches(const Rig& rig, const PairSum& sum);

}  // namespace duo
