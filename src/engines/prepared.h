// What every engine settles before the first frame: checked choices, geometry, and the frame's memory.
#pragma once

#include <memory>
#include <optional>

#include "calib/rectification.h"
#include "duoptic/engine.h"
#include "duoptic/frame.h"
#include "matchers/matchers.h"

namespace duo {

struct Prepared {
  Setup setup;
  bool median = false, gaussian = false, diffusion = false;  // denoising, resolved
  bool color = false;                                        // wanted, or needed by who observes
  bool match_color = false, match_fill = false;              // the matcher takes colours, and is asked what holes would have
  std::optional<Rectification> rectification;
  std::optional<Rectified> geometry;
  Size size;  // of the rectified pictures
  Matchers::Choice matcher;
  std::shared_ptr<ClearStream> stream = std::make_shared<ClearStream>();  // of all who match for this setup
};

/// Checks the setup and computes the geometry.
///
/// Errors  unknown matcher, preset or parameter; values out of range; a rig of another resolution or that cannot be rectified;
///         depth wanted without a rig
Result<Prepared> prepare_setup(const Setup& setup);

MatchSetup match_setup(const Prepared& prepared);

/// What coding left in the noisier picture, sigma in 1/16 gray levels; 0 where that is not known, and where pictures are
/// denoised, which smooths it, too.
int coding_noise_q4(const Prepared& prepared, const Pair& pair);

/// The numerator of depth: focal_px * baseline_mm.
float focal_baseline_px_mm(const Rectified& geometry);

/// A frame with the memory for all maps that the setup wants.
Frame make_frame(const Prepared& prepared);

}  // namespace duo
