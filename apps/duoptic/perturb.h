// Pairs made as unlike as two different webcams make them.
#pragma once

#include <span>

#include "duoptic/frame.h"

namespace duo::app {

struct Perturbation {
  const char* name;
  bool gain = false;   // right picture times 0.8, plus 10
  bool noise = false;  // Gaussian noise of sigma 4 on both
  bool rows = false;   // right picture half a pixel up: the mean of each row and the next
};

/// Each fault alone, then all of them.
std::span<const Perturbation> perturbations();

/// The pair with these faults, always the same ones.
Pair perturb(const Pair& pair, const Perturbation& how);

}  // namespace duo::app
