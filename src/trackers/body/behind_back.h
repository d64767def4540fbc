// Arms that go behind the trunk of somebody who faces the cameras. There the network of hands sees nothing, and the network of
// bodies marks wrist and hand where the forearm goes in, or on the upper arm.
#pragma once

#include <optional>

#include "trackers/body/scene.h"

namespace duo::body {

/// Where the network marks the end of an arm whose wrist is expected behind the trunk on the upper arm, where no wrist can be,
/// the last place tells more: puts the marks of wrist and hand there.
void leave_upper_arm(Scene& scene, const Limb& arm);

/// Where the arm lies on the back, `length` from its elbow, in the direction in which the wrist is marked. None where the
/// network of hands saw the hand or did not look, or where the back is out of reach.
std::optional<Vec3> on_back(const Scene& scene, JointId wrist, Vec3 elbow, double length);

}  // namespace duo::body
