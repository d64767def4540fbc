// Drawings of a calibration as SVG, in pixels of the raw picture where they show one.
#pragma once

#include <string>

#include "duoptic/calibrate.h"

namespace duo {

/// Text with what HTML would take for its own replaced.
std::string html_of(const std::string& text);

/// Where the corners of all views lie in one camera's picture (0 left, 1 right), cells without any in red.
std::string coverage_svg(const Calibration& calibration, int camera);

/// Arrows from predicted corners to seen ones, longer by a round factor that is written on it.
std::string residuals_svg(const Calibration& calibration, int camera);

/// The same differences around one point: a round cloud is noise.
std::string scatter_svg(const Calibration& calibration, int camera);

/// Root mean square of each view's corners, a bar a camera.
std::string views_svg(const Calibration& calibration);

/// Both rectified pictures with lines along their rows.
///
/// Errors  those of rectify_pair(); the pictures cannot be encoded
Result<std::string> rows_svg(const Rig& rig, const Pair& pair);

}  // namespace duo
