// Small gray patches of the clothes, found again by normalised correlation.
#pragma once

#include <array>
#include <optional>

#include "trackers/arm/gray_levels.h"

namespace duo::arm {

/// A square of (2 R + 1)^2 samples with mean 0 and length 1.
template <int R>
struct PatchPixels {
  static constexpr int kRadius = R, kSide = 2 * R + 1;
  std::array<float, kSide * kSide> values;
};

struct Patch {
  Vec3 p_in_torso_m;
  double first_z_m = 0;  // depth where it was cut out: it looks larger when it comes nearer
  PatchPixels<6> full;
  PatchPixels<4> half;
};

/// Cuts a patch out around a place of the full level; none at the border or where the picture is bare.
std::optional<Patch> cut_patch(const GrayLevels& gray, Vec2 at_px);

struct PatchMatch {
  Vec2 at_px;        // of the full level, to a fraction of a pixel
  double score = 0;  // correlation, up to 1
};

/// Looks for a patch that appears `scale` times as large as it was cut out, up to `reach` pixels of the half level around a
/// place of the full one. None below a correlation of one half.
///
/// Source  coarse to fine as Burt, Adelson, "The Laplacian pyramid as a compact image code", 1983
std::optional<PatchMatch> find_patch(const GrayLevels& gray, const Patch& patch, Vec2 near_px, double scale, int reach);

/// The smaller eigenvalue of the gradient matrix over 7 x 7 pixels; (x, y) at least four pixels from the border.
///
/// Source  Shi, Tomasi, "Good features to track", 1994
double corner_strength(const GrayLevel& gray, int x, int y);

}  // namespace duo::arm
