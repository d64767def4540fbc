#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/check.h"
#include "duoptic/synthetic.h"
#include "sources/synthetic/backdrop.h"
#include "sources/synthetic/figure.h"
#include "sources/synthetic/furniture.h"
#include "sources/synthetic/mounting.h"
#include "sources/synthetic/noise.h"
#include "sources/synthetic/room.h"
#include "sources/synthetic/script.h"

namespace duo {

using namespace synthetic;

// Where the rig stands, and where the people do at first.
struct Staging {
  Rigid3 world_from_rig, world_from_stage;
};

namespace {

constexpr double kFramesPerSecond = 30;

Staging stage(const SyntheticClipSetup& setup, double scale) {
  Random random(setup.seed ^ 0x57a6eU);
  const double aside = random.uniform(-3, 3), turned = random.uniform(-6, 6);
  const double farther_m = is_of_whole_body(setup.script) ? 0.35 : 0, distance_m = farther_m + random.uniform(1.88, 2.02);
  // The camera is tilted so that the picture's upper edge lies a hand above the hair, whatever its shape.
  constexpr double kHair_m = 1.78, kRoom_m = 0.1;
  const Camera camera = ideal_camera(setup.size);
  const Vec3 to_top = normalized({0, kHair_m * scale + kRoom_m - kFloor_m, distance_m});
  const Vec3 edge = normalized({0, (setup.size.height / 2.0) / camera.fy_px, 1});
  const double c = dot(to_top, edge), s = to_top.y * edge.z - to_top.z * edge.y;
  const Mat3 tilt{{1, 0, 0, 0, c, -s, 0, s, c}}, turn = about_y(aside);
  return {{turn * tilt, {}}, {turn * about_y(turned), turn * Vec3{0, 0, distance_m} + Vec3{0, kFloor_m, 0}}};
}

// The room; with a chair for those who sit down.
Scene room_of(const SyntheticClipSetup& setup, const Staging& staging) {
  constexpr double kBehind_m = 0.4;
  Scene room = living_room(setup.seed, 0, Floor::kFree);
  if (setup.script != "sit") return room;
  const int wood = room.add({.texture = Texture::kWood, .a = srgb(0x8a5a38), .b = srgb(0x3a2212), .gloss = 0.15});
  const int cushion = room.add({.texture = Texture::kKnit, .a = srgb(0xc8442f), .b = srgb(0xd8cbb0), .scale_m = 0.03});
  add_chair({room, staging.world_from_stage * Rigid3{{}, {0, 0, kBehind_m}}}, wood, cushion);
  room.ready();
  return room;
}

struct NamedJoint {
  JointId id;
  Vec3 p_in_person_m;
};

std::vector<NamedJoint> joints_of(const Bones& bones) {
  const auto &l = bones.arms[kLeftSide], &r = bones.arms[kRightSide], &ll = bones.legs[kLeftSide], &rl = bones.legs[kRightSide];
  std::vector<NamedJoint> out = {{JointId::kLeftShoulder, l.root_m},  {JointId::kLeftElbow, l.middle_m},
                                 {JointId::kLeftWrist, l.end_m},      {JointId::kLeftHand, bones.hands_m[kLeftSide]},
                                 {JointId::kLeftHip, ll.root_m},      {JointId::kLeftKnee, ll.middle_m},
                                 {JointId::kLeftAnkle, ll.end_m},     {JointId::kLeftFoot, bones.feet_m[kLeftSide]},
                                 {JointId::kRightShoulder, r.root_m}, {JointId::kRightElbow, r.middle_m},
                                 {JointId::kRightWrist, r.end_m},     {JointId::kRightHand, bones.hands_m[kRightSide]},
                                 {JointId::kRightHip, rl.root_m},     {JointId::kRightKnee, rl.middle_m},
                                 {JointId::kRightAnkle, rl.end_m},    {JointId::kRightFoot, bones.feet_m[kRightSide]},
                                 {JointId::kHead, bones.head_m},      {JointId::kNeck, bones.neck_m},
                                 {JointId::kPelvis, bones.pelvis_m}};
  // Fingers bend once: of the two joints between root and tip the first.
  constexpr std::array<std::size_t, 3> kBent = {0, 1, 3};
  for (const int side : {kLeftSide, kRightSide})
    for (std::size_t finger = 0; finger < kFingers; ++finger) {
      const Finger& bent = bones.fingers[side][finger];
      const Vec3 at_m[] = {bent.root_m, bent.bend_m, bent.tip_m};
      for (std::size_t i = 0; i < 3; ++i)
        out.push_back({finger_joint(side == kLeftSide ? duo::Side::kLeft : duo::Side::kRight, {finger, kBent[i]}),
                       bones.arms[side].person_from_end * (bones.scale * at_m[i])});
    }
  return out;
}

// A joint in one camera.
struct Seen {
  std::optional<std::array<double, 2>> uv_px;
  bool in = false, visible = false;
  std::optional<double> surface_z_m;
};

Seen look_at(Vec3 p_in_world, const Camera& camera, const Rigid3& world_from_camera, const Scene& room, const Scene& figure,
             double tolerance_m) {
  constexpr double kFarOutside = 0.6;  // of the width
  Seen out;
  const Vec3 p = inverse(world_from_camera) * p_in_world;
  const double reach_x = (0.5 + kFarOutside) * camera.size.width / camera.fx_px;
  const double reach_y = (0.5 * camera.size.height + kFarOutside * camera.size.width) / camera.fy_px;
  if (p.z <= 0 || std::abs(p.x) > reach_x * p.z || std::abs(p.y) > reach_y * p.z) return out;
  const Point2 at = project(camera, {p.x / p.z, p.y / p.z});
  out.uv_px = {at.x, at.y};
  out.in = at.x >= 0 && at.y >= 0 && at.x <= camera.size.width - 1 && at.y <= camera.size.height - 1;
  const Ray ray{world_from_camera.t_m, (1 / p.z) * (p_in_world - world_from_camera.t_m)};
  const double room_z = room.trace(ray).t, figure_z = figure.trace(ray).t;
  if (figure_z < room_z) out.surface_z_m = figure_z;
  out.visible = out.in && (p.z - std::min(room_z, figure_z)) * norm(ray.direction) <= tolerance_m;
  return out;
}

}  // namespace

struct SyntheticClip::State {
  SyntheticClipSetup setup;
  Pool pool;
  struct Actor {
    Looks looks;
    Script script;
  };
  std::vector<Actor> actors;
  Staging staging;
  Mounting mounts;
  Rig rig;
  Scene room;
  Rigid3 world_from_left, world_from_right;
  std::optional<Backdrop> left, right;  // the still room, from the first frame on

  State(const SyntheticClipSetup& wanted, int threads, int arm)
      : setup(wanted),
        pool(threads),
        actors(actors_of(setup, arm)),
        staging(stage(setup, actors.front().looks.scale)),
        mounts(mounting({.size = setup.size, .seed = setup.seed})),
        rig(rig_of(mounts)),
        room(room_of(setup, staging)),
        world_from_left(staging.world_from_rig * mounts.left.rig_from_camera),
        world_from_right(staging.world_from_rig * mounts.right.rig_from_camera) {
    setup.arm = arm == kRightSide ? SyntheticArm::kRight : SyntheticArm::kLeft;
    if (setup.frames == 0) setup.frames = static_cast<int>(std::lround(actors.front().script.length_s() * kFramesPerSecond));
  }

  static std::vector<Actor> actors_of(const SyntheticClipSetup& setup, int arm) {
    const bool any_body = is_of_whole_body(setup.script);
    std::vector<Actor> out;
    out.push_back({any_body ? passer_by_of(setup.seed) : looks_of(setup.seed), {acts_of(setup.script), arm, setup.seed}});
    if (auto acts = second_acts_of(setup.script); !acts.empty()) {
      const std::uint32_t seed = mix(setup.seed);
      out.push_back({passer_by_of(seed), {std::move(acts), 1 - arm, seed}});
    }
    return out;
  }

  // A person at one moment.
  struct Posed {
    Rigid3 world_from_person;
    Bones bones;
  };
  // What there is to see at one moment.
  struct Shot {
    std::string_view act;
    Lamps lamps;
    std::vector<Posed> people;
    Scene figures;
  };
  Shot shot(double t_s) const {
    Shot out;
    for (const Actor& actor : actors) {
      const Script::Moment moment = actor.script.at(t_s);
      if (out.people.empty()) out.act = moment.act, out.lamps = {moment.lamp};
      const Posed posed = {staging.world_from_stage * moment.stage_from_person, make_bones(moment.pose, actor.looks.scale)};
      add_figure(out.figures, posed.world_from_person, posed.bones, actor.looks);
      out.people.push_back(posed);
    }
    light_like(room, out.lamps, out.figures);
    out.figures.ready();
    return out;
  }

  std::vector<SyntheticJoint> joints(std::size_t person, const Shot& shot, const Shot& right_shot) const {
    std::vector<SyntheticJoint> out;
    const Posed &posed = shot.people[person], &right_posed = right_shot.people[person];
    const auto named = joints_of(posed.bones), right_named = joints_of(right_posed.bones);
    for (std::size_t i = 0; i < named.size(); ++i) {
      const JointId id = named[i].id;
      const Vec3 p = posed.world_from_person * named[i].p_in_person_m,
                 right_p = right_posed.world_from_person * right_named[i].p_in_person_m;
      const double tolerance = tolerance_m(id);
      const Seen l = look_at(p, rig.left, world_from_left, room, shot.figures, tolerance),
                 r = look_at(right_p, rig.right, world_from_right, room, right_shot.figures, tolerance);
      out.push_back({id, inverse(world_from_left) * p, l.uv_px, r.uv_px, l.in, r.in, l.visible, r.visible, l.surface_z_m});
    }
    return out;
  }
};

Result<SyntheticClip> SyntheticClip::open(const SyntheticClipSetup& setup, int threads) {
  constexpr int kMaxSide = 4096, kMaxFrames = 100000;
  constexpr double kMaxSkew_s = 0.1;
  const auto refused = [](const std::string& why) {
    return Error{ErrorCode::kBadInput, "cannot render a synthetic clip: " + why};
  };
  if (acts_of(setup.script).empty())
    return refused(
        fmt::format("there is no script '{}'; choose one of {}", setup.script, fmt::join(synthetic_scripts(), ", ")));
  if (setup.size.empty() || setup.size.width > kMaxSide || setup.size.height > kMaxSide)
    return refused(fmt::format("{}x{} pixels; choose 1 to {} each way", setup.size.width, setup.size.height, kMaxSide));
  if (setup.frames < 0 || setup.frames > kMaxFrames)
    return refused(fmt::format("{} frames; choose 1 to {}, or 0 for the script once", setup.frames, kMaxFrames));
  if (!(std::abs(setup.skew_s) <= kMaxSkew_s))
    return refused(fmt::format("the right camera {} s late; choose {} at most", setup.skew_s, kMaxSkew_s));
  int arm = setup.arm == SyntheticArm::kLeft ? kLeftSide : kRightSide;
  if (setup.arm == SyntheticArm::kBySeed) arm = (setup.seed & 1) != 0 ? kRightSide : kLeftSide;
  return SyntheticClip(std::make_unique<State>(setup, threads, arm));
}

SyntheticClip::SyntheticClip(std::unique_ptr<State> state) : state_(std::move(state)) {}
SyntheticClip::SyntheticClip(SyntheticClip&&) noexcept = default;
SyntheticClip::~SyntheticClip() = default;

const SyntheticClipSetup& SyntheticClip::setup() const { return state_->setup; }
const Rig& SyntheticClip::rig() const { return state_->rig; }

SyntheticClipFrame SyntheticClip::frame(int index) {
  State& s = *state_;
  SyntheticClipFrame out;
  out.t_s = index / kFramesPerSecond;
  if (!s.left) s.left.emplace(s.pool, s.room, s.mounts.left.camera, s.world_from_left);
  if (!s.right) s.right.emplace(s.pool, s.room, s.mounts.right.camera, s.world_from_right);
  const State::Shot shot = s.shot(out.t_s), right_shot = s.shot(out.t_s + s.setup.skew_s);
  out.act = shot.act;
  out.ceiling_light = shot.lamps.ceiling;

  const SyntheticSetup at{.size = s.setup.size, .seed = s.setup.seed, .t_s = out.t_s};
  Backdrop::Drawn left = s.left->draw(s.pool, shot.figures, shot.lamps),
                  right = s.right->draw(s.pool, right_shot.figures, right_shot.lamps);
  out.pair.left = taken(develop(s.pool, left.colors, webcam(at, 0)), out.t_s);
  out.pair.right = taken(develop(s.pool, right.colors, webcam(at, 1)), out.t_s + s.setup.skew_s);
  out.pair.sequence = out.pair.left.sequence = out.pair.right.sequence = static_cast<std::uint64_t>(index);
  out.depth_left_m = std::move(left.z_m);
  out.figure_left = std::move(left.is_figure);
  out.joints = s.joints(0, shot, right_shot);
  for (std::size_t person = 1; person < s.actors.size(); ++person) out.others.push_back(s.joints(person, shot, right_shot));
  return out;
}

SyntheticClip::Pinhole SyntheticClip::pinhole(int index) {
  State& s = *state_;
  const Scene figure = s.shot(index / kFramesPerSecond).figures;
  Camera camera = s.rig.left;
  camera.distortion = {};
  const Size size = camera.size;
  Pinhole out{Image<float>(size), Image<std::uint8_t>(size)};
  each_row(s.pool, size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) {
      const Ray ray = pixel_ray(camera, s.world_from_left, {static_cast<double>(x), static_cast<double>(y)});
      const double room_z = s.room.trace(ray).t, figure_z = figure.trace(ray).t;
      out.depth_m.at(y, x) = static_cast<float>(std::min(room_z, figure_z));
      out.figure.at(y, x) = figure_z < room_z ? 255 : 0;
    }
  });
  return out;
}

double SyntheticClip::tolerance_m(JointId joint) {
  constexpr double kFinger_m = 0.025;
  if (is_finger(joint)) return kFinger_m;
  constexpr std::pair<const char*, double> kTolerances[] = {
      {"shoulder", 0.14}, {"elbow", 0.1}, {"wrist", 0.065}, {"hand", 0.06}, {"hip", 0.17},   {"knee", 0.1},
      {"ankle", 0.09},    {"foot", 0.08}, {"head", 0.16},   {"neck", 0.1},  {"pelvis", 0.18}};
  for (const auto& [part, tolerance] : kTolerances)
    if (part_of(joint) == part) return tolerance;
  DUO_CHECK(false);
  return 0;
}

std::vector<std::string> synthetic_scripts() {
  std::vector<std::string> names = act_names();
  names.push_back("tour");
  return names;
}

}  // namespace duo
