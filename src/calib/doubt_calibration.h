// What a user should know before trusting a calibration.
#pragma once

#include <string>
#include <vector>

#include "duoptic/calibrate.h"

namespace duo {

/// One line each, with what to do about it: parts of the pictures without corners, few or rejected views, an overfitted or bent
/// board, depth that stays uncertain, and rig_doubts().
std::vector<std::string> doubts_of(const Calibration& calibration);

}  // namespace duo
