// What the frame shows along a limb between its joints: how deep it lies, and where its middle is.
#pragma once

#include <array>
#include <span>

#include "trackers/body/choose.h"

namespace duo::body {

/// A cut across a limb.
///
/// Units  share: from joint a (0) to joint b (1); z_m: of the bone; middle_px: between the limb's edges, along normal
struct LimbSample {
  JointId a, b;
  double share = 0;
  double z_m = 0, z_sigma_m = 0;
  bool has_edges = false;
  Vec2 middle_px, normal;
  double sigma_px = 0;
};

struct LimbSamples {
  std::array<LimbSample, 40> all = {};
  std::size_t count = 0;
  std::span<const LimbSample> get() const { return {all.data(), count}; }
};

/// Four cuts across each upper arm, forearm, thigh and shin whose joints both lie on surfaces.
void sample_limbs(const Scene& scene, const Choices& chosen, LimbSamples& out);

}  // namespace duo::body
