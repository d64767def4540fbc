// The networks' results as points of bodies and hands.
#pragma once

#include "core/tensor.h"
#include "duoptic/detector.h"

namespace duo {

inline constexpr int kBodySide = 256, kHandSide = 224;

/// A network's result and its step, 2^-exponent.
struct Result16 {
  ConstTensor16 values;
  int exponent = 0;
};

/// A body from the networks' results for a region.
///
/// Shape   points 39 x (x, y, z in px of the crop, visible, present before the sigmoid); heat 64 x 64 x 39 before the sigmoid;
/// world
///         39 x (x, y, z in m); presence 1 before the sigmoid. Points 33 and 34 are the hips' middle and a point of the circle
///         around the person
/// Source  Bazarevsky et al., "BlazePose", 2020; a point whose heat reaches 0.5 within 7 x 7 places around it becomes the mean
/// of
///         these places weighted by their heat
SeenBody see_body(const Result16& points, const Result16& heat, const Result16& world, const Result16& presence,
                  const TurnedSquare& region);

/// Shape  points and world 21 x (x, y, z); presence and side 1 before the sigmoid
SeenHand see_hand(const Result16& points, const Result16& world, const Result16& presence, const Result16& side,
                  const TurnedSquare& region);

}  // namespace duo
