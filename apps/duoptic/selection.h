// What --select says: which joints of whom were clicked, and where.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "duoptic/tracker.h"

namespace duo::app {

/// Each of "right_hand=451,360"; "hand=…" without a side is that of `side`. A selection per skeleton of the tracker's, in the
/// order in which they are named.
///
/// Throws  CLI::ValidationError: not JOINT=X,Y, no such joint, a joint twice or missing
std::vector<Selection> parse_selections(const std::vector<std::string>& texts, const std::string& side,
                                        std::span<const Skeleton* const> skeletons);

/// The names of all joints of skeletons: "right_shoulder, right_elbow, …".
std::string joint_names(std::span<const Skeleton* const> skeletons);

}  // namespace duo::app
