// Which surface carries a joint, or whether it is hidden: decided for whole limbs, both sides together.
#pragma once

#include "trackers/body/scene.h"

namespace duo::body {

/// A joint as chosen.
struct Choice {
  Vec3 p;
  bool on_surface = false;  // else hidden: p is a guess
  double z_sigma_m = 0;     // of a joint on a surface
};
using Choices = PerJoint<Choice>;

/// Chooses every joint; the trunk first, whose axes then tell arms before it from the trunk itself.
///
/// Shoulders and hips are chosen in pairs that are as far apart as the person is wide and turned as the network says. Limbs are
/// the best chains over surfaces and hidden guesses. Where both arms or both legs want one surface, one of them gives way: the
/// one that loses less by it.
///
/// Source  dynamic programming over a chain as in Felzenszwalb, Huttenlocher, "Pictorial structures for object recognition",
/// 2005
void choose(Scene& scene, Choices& out);

}  // namespace duo::body
