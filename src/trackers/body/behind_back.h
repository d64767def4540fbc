// Arms that go behind the trunk of somebody who faces the cameras. There the network of hands sees nothing, and the network of
// bodies marks wrist and hand where the forearm goes in, or on the upper arm.
#pragma once

#include <optional>

#include "trackers/body/scene.h"

namespace duo::body {

/// Puts the marks of wrist and hand at their expected places where the wrist is expected behind the trunk and the network marks
/// the wrist on the upper arm, where none can be.
void leave_upper_arm(Scene& scene, const Limb& arm);

/// Where the arm lies on the back, `length` from its elbow, in the direction in which the wrist is marked. The back is taken as
/// deep as beside the elbow. None where the network of hands saw the hand or did not look, where the wrist is marked within 4
/// cm of the elbow, where the trunk does not face the cameras, or where the back is out of reach.
std::optional<Vec3> on_back(const Scene& scene, JointId wrist, Vec3 elbow, double length);

}  // namespace duo::body
