// The body that explains points, depth and bones best: least squares over all joints at once.
#pragma once

#include "duoptic/person.h"
#include "trackers/body/choose.h"
#include "trackers/body/limb_samples.h"
#include "trackers/body/normal_equations.h"

namespace duo::body {

struct Fitted {
  Places places;                     // of the free joints; the others follow from them
  PerJoint<Covariance3> covariance;  // as the equations have it
};

/// Six steps of Gauss and Newton. Points and depth may be wrong, so their weight falls with the residual (Cauchy); bones are
/// kept.
///
/// Source  Knoop, Vacek, Dillmann, "Sensor fusion for 3D human body tracking with an articulated 3D body model", 2006: points,
/// depth
///         and joints of a body in one system; Holland, Welsch, "Robust regression using iteratively reweighted least-squares",
///         1977
class Fit {
 public:
  void run(const Scene& scene, const Choices& chosen, const LimbSamples& samples, Fitted& out);

 private:
  PointEquations<kFreeJoints.size()> equations_;
};

/// The same pose with bones as long as the person's, as these are kept: limbs, neck and trunk keep their directions, and the
/// trunk its middle.
Places with_lengths(const Places& places, const Lengths& lengths);

inline constexpr double kNeckAbove = 0.225;  // the chest, of the trunk's length

/// Pelvis, spine, chest and neck from shoulders and hips.
void complete(Places& places);

}  // namespace duo::body
