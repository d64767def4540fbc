// The tracker turns frames into joints: predict where they are, observe them in the frame, update.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "duoptic/engine.h"
#include "duoptic/frame.h"
#include "duoptic/result.h"
#include "duoptic/rig.h"

namespace duo {

enum class JointState : std::uint8_t {
  kSeen,      // measured in this frame
  kInferred,  // hidden: predicted from what is known of the body; sigma_m grows with time
  kLost,      // could be anywhere the arm reaches; the position means nothing
};

/// One joint at one instant.
///
/// Units   p_in_rig_m: the joint's centre inside the body, metres in the rig frame; sigma_m: one standard deviation of its
///         distance from the truth; u_px, v_px: where the joint projects in the raw left picture; confidence 0 .. 1
struct Keypoint {
  Vec3 p_in_rig_m;
  double sigma_m = 0, confidence = 0;
  double u_px = 0, v_px = 0;
  JointState state = JointState::kLost;
};

enum class Joint : std::uint8_t { kHand, kElbow, kShoulder };
inline constexpr int kArmJoints = 3;
inline constexpr std::array<std::string_view, kArmJoints> kJointNames = {"hand", "elbow", "shoulder"};

struct ArmPose {
  std::array<Keypoint, kArmJoints> joints;
  Keypoint& operator[](Joint joint) { return joints[static_cast<std::size_t>(joint)]; }
  const Keypoint& operator[](Joint joint) const { return joints[static_cast<std::size_t>(joint)]; }
};

/// Where the user clicked, raw left pixels; one arm.
struct ArmSelection {
  struct Click {
    double x_px = 0, y_px = 0;
  };
  std::array<Click, kArmJoints> clicks;  // hand, elbow, shoulder
};

struct TrackerSetup {
  Rig rig;
  Rectified rectified;  // of the frames to come
  double frame_s = 1.0 / 30;
};

/// Follows the selected arms through frames that have what it wants.
///
/// Errors   all that can fail is in prepare() and select(); a failed call leaves the tracker as it was
/// Threads  one caller
class Tracker {
 public:
  virtual ~Tracker() = default;
  virtual const char* name() const = 0;
  /// What its frames must have.
  virtual Wants wants() const = 0;
  virtual Result<void> prepare(const TrackerSetup& setup) = 0;
  /// Starts tracking one or two arms from clicks on this frame; forgets arms selected before.
  ///
  /// Errors  a click outside the picture, or where the frame has no depth nearby: which joint, and what to do
  virtual Result<void> select(const Frame& frame, const std::vector<ArmSelection>& arms) = 0;
  /// The arms in this frame, in the order of select(); empty before it. Valid until the next call.
  virtual const std::vector<ArmPose>& track(const Frame& frame) = 0;
  virtual void reset() = 0;
  /// What its last look took on the device, where the engine times stages; ends at the first with wall_ns 0.
  virtual std::span<const StageTime> stages() const { return {}; }
};

/// Makes a tracker by name ("arm") and preset ("default", "thesis").
///
/// Errors  unknown name or preset, with the known ones
Result<std::unique_ptr<Tracker>> make_tracker(std::string_view name, std::string_view preset);

}  // namespace duo
