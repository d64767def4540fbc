// Virtual Motion Capture protocol, performer to marionette: https://protocol.vmc.info
#include <fmt/format.h>

#include <utility>

#include "duoptic/sink.h"
#include "sinks/arm_bones.h"
#include "sinks/osc_target.h"

namespace duo {
namespace {

/// Unity's axes (left-handed, y up) of an avatar that looks along z, as the person looks towards the cameras: -1 times the
/// rig frame in every direction.
Vec3 avatar_from_rig(Vec3 p_in_rig) { return -1.0 * p_in_rig; }

class Vmc final : public Sink {
 public:
  Vmc(OscTarget target, ArmSide first_arm) : target_(std::move(target)), first_arm_(first_arm) {}

  Result<void> write(const TrackedFrame& frame) override {
    const OscBundle bundle = new_bundle();
    bool known = false;
    for (const ArmPose& arm : frame.arms) known |= is_known(arm);
    lo_message ok = lo_message_new(), time = lo_message_new();
    lo_message_add_int32(ok, known ? 1 : 0);
    lo_message_add_float(time, static_cast<float>(frame.t_s));
    lo_bundle_add_message(bundle.get(), "/VMC/Ext/OK", ok);
    lo_bundle_add_message(bundle.get(), "/VMC/Ext/T", time);
    add_transform(bundle, "/VMC/Ext/Root/Pos", "root", {}, Mat3{});
    for (std::size_t arm = 0; arm < frame.arms.size(); ++arm) {
      while (turners_.size() <= arm) turners_.emplace_back(rest_x(side_of(first_arm_, turners_.size()), true));
      if (is_known(frame.arms[arm])) add_arm(bundle, frame.arms[arm], side_of(first_arm_, arm), turners_[arm]);
    }
    target_.send(bundle);
    return {};
  }
  bool instant() const override { return true; }
  std::int64_t dropped() const override { return target_.dropped(); }
  Result<void> finish() override { return {}; }

 private:
  static bool is_known(const ArmPose& arm) {
    for (const Keypoint& joint : arm.joints)
      if (joint.state == JointState::kLost) return false;
    return true;
  }

  /// Position in the parent bone (metres), rotation from the T-pose in the parent's axes.
  static void add_transform(const OscBundle& bundle, const char* path, const std::string& name, Vec3 p_m,
                            const Mat3& rotation) {
    lo_message message = lo_message_new();
    lo_message_add_string(message, name.c_str());
    for (const double v_m : {p_m.x, p_m.y, p_m.z}) lo_message_add_float(message, static_cast<float>(v_m));
    for (const double q : quaternion(rotation)) lo_message_add_float(message, static_cast<float>(q));
    lo_bundle_add_message(bundle.get(), path, message);
  }

  static void add_arm(const OscBundle& bundle, const ArmPose& arm, ArmSide side, ArmTurner& turner) {
    const Vec3 shoulder = avatar_from_rig(arm[Joint::kShoulder].p_in_rig_m),
               elbow = avatar_from_rig(arm[Joint::kElbow].p_in_rig_m), hand = avatar_from_rig(arm[Joint::kHand].p_in_rig_m);
    const auto turns = turner.turn(shoulder, elbow, hand);
    if (!turns) return;
    const double x = rest_x(side, true);
    const std::string name(side_name(side));
    const auto bone = [&](const char* part, double length_m, const Mat3& rotation) {
      add_transform(bundle, "/VMC/Ext/Bone/Pos", name + part, {x * length_m, 0, 0}, rotation);
    };
    // The avatar's own shoulder is where its arm begins: the person's place in the room is OSC's to tell.
    bone("UpperArm", 0, turns->upper);
    bone("LowerArm", norm(elbow - shoulder), turns->lower);
    bone("Hand", norm(hand - elbow), Mat3{});
  }

  OscTarget target_;
  ArmSide first_arm_;
  std::vector<ArmTurner> turners_;
};

}  // namespace

Result<std::unique_ptr<Sink>> make_vmc(const std::string& target, const TrackHeader& header) {
  DUO_TRY_ASSIGN(OscTarget opened, OscTarget::open(target));
  return std::unique_ptr<Sink>(std::make_unique<Vmc>(std::move(opened), header.first_arm));
}

}  // namespace duo
