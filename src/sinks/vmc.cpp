// Virtual Motion Capture protocol, performer to marionette: https://protocol.vmc.info
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "body/bone_turns.h"
#include "duoptic/sink.h"
#include "sinks/osc_target.h"

namespace duo {
namespace {

/// Unity's axes (left-handed, y up) of an avatar that looks along z, as the person looks towards the cameras: -1 times the
/// rig frame in every direction.
constexpr Mat3 kAvatarFromRig = {{-1, 0, 0, 0, -1, 0, 0, 0, -1}};

/// Unity's HumanBodyBones by the joint at which each begins. A hand's centre begins no bone: it stands for the wrist of a
/// skeleton without one. Nor does the tip of a finger: it has the name of its bone.
constexpr std::array<std::string_view, kJointIds> kHumanoidBones = {"Hips",
                                                               "Spine",
                                                               "Chest",
                                                               "Neck",
                                                               "Head",
                                                               "LeftUpperArm",
                                                               "LeftLowerArm",
                                                               "LeftHand",
                                                               "LeftHand",
                                                               "RightUpperArm",
                                                               "RightLowerArm",
                                                               "RightHand",
                                                               "RightHand",
                                                               "LeftUpperLeg",
                                                               "LeftLowerLeg",
                                                               "LeftFoot",
                                                               "LeftToes",
                                                               "RightUpperLeg",
                                                               "RightLowerLeg",
                                                               "RightFoot",
                                                               "RightToes",
                                                               "LeftThumbProximal",
                                                               "LeftThumbIntermediate",
                                                               "LeftThumbDistal",
                                                               "LeftThumbDistal",
                                                               "LeftIndexProximal",
                                                               "LeftIndexIntermediate",
                                                               "LeftIndexDistal",
                                                               "LeftIndexDistal",
                                                               "LeftMiddleProximal",
                                                               "LeftMiddleIntermediate",
                                                               "LeftMiddleDistal",
                                                               "LeftMiddleDistal",
                                                               "LeftRingProximal",
                                                               "LeftRingIntermediate",
                                                               "LeftRingDistal",
                                                               "LeftRingDistal",
                                                               "LeftLittleProximal",
                                                               "LeftLittleIntermediate",
                                                               "LeftLittleDistal",
                                                               "LeftLittleDistal",
                                                               "RightThumbProximal",
                                                               "RightThumbIntermediate",
                                                               "RightThumbDistal",
                                                               "RightThumbDistal",
                                                               "RightIndexProximal",
                                                               "RightIndexIntermediate",
                                                               "RightIndexDistal",
                                                               "RightIndexDistal",
                                                               "RightMiddleProximal",
                                                               "RightMiddleIntermediate",
                                                               "RightMiddleDistal",
                                                               "RightMiddleDistal",
                                                               "RightRingProximal",
                                                               "RightRingIntermediate",
                                                               "RightRingDistal",
                                                               "RightRingDistal",
                                                               "RightLittleProximal",
                                                               "RightLittleIntermediate",
                                                               "RightLittleDistal",
                                                               "RightLittleDistal"};

std::string_view bone_of(const JointDef& joint) { return kHumanoidBones[static_cast<std::size_t>(joint.id)]; }

/// The bones of one person keep the lengths of the first pose that is known: an avatar whose bones change is torn.
struct Avatar {
  Avatar(const Skeleton& skeleton, const std::vector<Vec3>& places) : turner(skeleton, BodyAxes::kLeftHanded) {
    for (std::size_t j = 0; j < places.size(); ++j) {
      const int parent = skeleton.joints[j].parent;
      length_m.push_back(parent < 0 ? 0 : norm(places[j] - places[static_cast<std::size_t>(parent)]));
    }
  }
  BoneTurner turner;
  std::vector<double> length_m;  // from the parent's joint; 0: it has none
};

class Vmc final : public Sink {
 public:
  Vmc(OscTarget target, VmcBones bones) : target_(std::move(target)), bones_(bones) {}

  Result<void> write(const TrackedFrame& frame) override {
    const OscBundle bundle = new_bundle();
    lo_message ok = lo_message_new(), time = lo_message_new();
    lo_bundle_add_message(bundle.get(), "/VMC/Ext/OK", ok);
    lo_message_add_float(time, static_cast<float>(frame.t_s));
    lo_bundle_add_message(bundle.get(), "/VMC/Ext/T", time);
    add_transform(bundle, "/VMC/Ext/Root/Pos", "root", {}, Mat3{});
    bool known = false;
    for (std::size_t i = 0; i < frame.people.size(); ++i) {
      const Person& person = frame.people[i];
      const auto same = [&](const Person& other) { return other.skeleton == person.skeleton; };
      if (std::none_of(frame.people.begin(), frame.people.begin() + static_cast<std::ptrdiff_t>(i), same))
        known |= add_person(bundle, person);
    }
    lo_message_add_int32(ok, known ? 1 : 0);
    target_.send(bundle);
    return {};
  }
  bool instant() const override { return true; }
  std::int64_t dropped() const override { return target_.dropped(); }
  Result<void> finish() override { return {}; }

 private:
  /// Position in the parent bone (metres), rotation from the T-pose in the parent's axes.
  static void add_transform(const OscBundle& bundle, const char* path, const char* name, Vec3 p_m, const Mat3& rotation) {
    lo_message message = lo_message_new();
    lo_message_add_string(message, name);
    for (const double v_m : {p_m.x, p_m.y, p_m.z}) lo_message_add_float(message, static_cast<float>(v_m));
    for (const double q : quaternion(rotation)) lo_message_add_float(message, static_cast<float>(q));
    lo_bundle_add_message(bundle.get(), path, message);
  }

  /// Whether its joints are known; those of an unknown one keep the avatar's pose.
  bool add_person(const OscBundle& bundle, const Person& person) {
    const auto places = known_places(person, kAvatarFromRig);
    if (!places) return false;
    Avatar& avatar = avatars_.try_emplace({person.id, person.skeleton}, *person.skeleton, *places).first->second;
    const auto turns = avatar.turner.turn(*places);
    if (!turns) return true;
    for (std::size_t j = 0; j < places->size(); ++j) {
      const JointDef& joint = person.skeleton->joints[j];
      // The avatar's own root is where its bones begin: the person's place in the room is OSC's to tell.
      Vec3 p_m;
      if (joint.parent >= 0) {
        const auto parent = static_cast<std::size_t>(joint.parent);
        if (bone_of(joint) == bone_of(person.skeleton->joints[parent])) continue;
        if (bones_ == VmcBones::kWhole) p_m = avatar.length_m[j] * rest_direction(joint.id, BodyAxes::kLeftHanded);
      }
      add_transform(bundle, "/VMC/Ext/Bone/Pos", bone_of(joint).data(), p_m, (*turns)[j]);
    }
    return true;
  }

  OscTarget target_;
  VmcBones bones_;
  std::map<std::pair<std::uint32_t, const Skeleton*>, Avatar> avatars_;  // by the person's id; it may be selected anew
};

}  // namespace

Result<std::unique_ptr<Sink>> make_vmc(const std::string& target, VmcBones bones) {
  DUO_TRY_ASSIGN(OscTarget opened, OscTarget::open(target));
  return std::unique_ptr<Sink>(std::make_unique<Vmc>(std::move(opened), bones));
}

}  // namespace duo
