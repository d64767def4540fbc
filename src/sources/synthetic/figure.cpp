#include "sources/synthetic/figure.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sources/synthetic/noise.h"

namespace duo::synthetic {
namespace {

constexpr double kNoCut = std::numeric_limits<double>::infinity();

// What a lobe has beside its ends and radii.
struct Form {
  double flat = 1;
  Vec3 thin = {0, 0, 1};  // the direction in which it is flat
  double soft_m = 0.02;
  double cut_m = kNoCut;  // from its start
};

// The lobes that hang on the bones of one shape. Points are given in a bone's frame, in metres of a person of 1.75 m.
class Flesh {
 public:
  explicit Flesh(double scale, double girth = 1) : scale_(scale), girth_(girth) {}

  /// The bone that the next lobes hang on, and where it lies in the resting body.
  void on(const Rigid3& person_from_bone, const Rigid3& rest_from_bone) {
    person_from_bone_ = person_from_bone;
    rest_from_bone_ = rest_from_bone;
  }
  void lobe(Vec3 from_m, Vec3 to_m, double from_radius_m, double to_radius_m, const Form& form = {}) {
    const Vec3 way = to_m - from_m;
    const double length = norm(way);
    const Vec3 y = length > 0 ? (1 / length) * way : Vec3{0, 1, 0};
    const Vec3 hint = std::abs(dot(form.thin, y)) < 0.95 ? form.thin : Vec3{1, 0, 0};
    const Vec3 x = normalized(cross(y, hint)), z = cross(x, y);
    const Mat3 turn = transposed(Mat3::from_rows(x, y, z));
    Lobe lobe{person_from_bone_ * Rigid3{turn, scale_ * from_m}, rest_from_bone_ * Rigid3{turn, scale_ * from_m}};
    lobe.length_m = scale_ * length;
    lobe.from_m = scale_ * girth_ * from_radius_m;
    lobe.to_m = scale_ * girth_ * to_radius_m;
    lobe.flat = form.flat;
    lobe.soft_m = scale_ * form.soft_m;
    lobe.cut_m = scale_ * form.cut_m;
    lobes_.push_back(lobe);
  }
  void ball(Vec3 at_m, double radius_m, const Form& form = {}) { lobe(at_m, at_m, radius_m, radius_m, form); }

  void add_to(Scene& scene, const Rigid3& world_from_person, int material) {
    Vec3 low{kNever, kNever, kNever}, high{-kNever, -kNever, -kNever};
    for (const Lobe& l : lobes_)
      for (const double y : {0.0, l.length_m}) {
        const Vec3 p = l.blend_from_lobe * Vec3{0, y, 0};
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      }
    const Vec3 middle = 0.5 * (low + high);
    for (Lobe& l : lobes_) l.blend_from_lobe.t_m = l.blend_from_lobe.t_m - middle;
    scene.shapes.push_back({Blend(std::move(lobes_)), world_from_person * Rigid3{{}, middle}, material});
  }

 private:
  double scale_, girth_;
  Rigid3 person_from_bone_, rest_from_bone_;
  std::vector<Lobe> lobes_;
};

// At rest the arms hang straight down beside the body.
struct Rest {
  double scale;
  Rigid3 upper_arm(int side) const { return at(outwards(side) * 0.3, -kShoulderHeight_m, 0); }
  Rigid3 forearm(int side) const { return at(outwards(side) * 0.3, -kShoulderHeight_m + kUpperArm_m, 0); }
  Rigid3 hand(int side) const { return at(outwards(side) * 0.3, -kShoulderHeight_m + kUpperArm_m + kForearm_m, 0); }
  Rigid3 thigh(int side) const { return at(outwards(side) * 0.092, -0.915, 0); }
  Rigid3 shin(int side) const { return at(outwards(side) * 0.092, -0.915 + kThigh_m, 0); }
  Rigid3 at(double x, double y, double z) const { return {{}, scale * Vec3{x, y, z}}; }
};

struct Dresser {
  Scene& scene;
  const Rigid3& world_from_person;
  const Bones& bones;
  const Looks& looks;
  Rest rest{bones.scale};

  void put(Flesh& flesh, int material) const { flesh.add_to(scene, world_from_person, material); }

  void head(int material) const {
    Flesh f(bones.scale);
    f.on(bones.person_from_head, {});
    f.lobe({0, -0.035, 0.014}, {0, 0.0, 0.014}, 0.074, 0.072, {.flat = 0.83});
    f.lobe({0, 0.0, -0.022}, {0, 0.075, -0.048}, 0.064, 0.043, {.soft_m = 0.03});
    f.ball({0, 0.098, -0.068}, 0.019, {.soft_m = 0.03});
    for (const double s : {-1.0, 1.0}) {
      f.ball({s * 0.036, 0.028, -0.054}, 0.029, {.soft_m = 0.02});
      f.lobe({s * 0.075, 0.0, 0.008}, {s * 0.077, 0.035, 0.002}, 0.019, 0.012,
             {.flat = 2.2, .thin = {1, 0, 0.35 * s}, .soft_m = 0.006});
      f.ball({s * 0.0125, 0.034, -0.096}, 0.0078, {.soft_m = 0.008});
    }
    f.lobe({-0.03, -0.026, -0.076}, {0.03, -0.026, -0.076}, 0.0125, 0.0125, {.soft_m = 0.02});
    f.lobe({0, -0.008, -0.089}, {0, 0.03, -0.105}, 0.0065, 0.0125, {.soft_m = 0.012});
    f.lobe({-0.019, 0.064, -0.084}, {0.019, 0.064, -0.084}, 0.0085, 0.0085, {.soft_m = 0.012});
    f.on(bones.person_from_torso, rest.at(0, kHeadHeight_m, 0.01));
    f.lobe({0, -1.46, 0.012}, {0, -1.58, -0.002}, 0.059, 0.052, {.soft_m = 0.015});
    put(f, material);
  }

  void hair(int material) const {
    Flesh f(bones.scale);
    f.on(bones.person_from_head, {});
    f.lobe({0, -0.046, 0.026}, {0, -0.01, 0.034}, 0.082, 0.07, {.flat = 0.86});
    f.lobe({-0.042, -0.086, -0.05}, {0.036, -0.094, -0.052}, 0.028, 0.032, {.soft_m = 0.03});
    f.ball({0.012, -0.105, -0.02}, 0.04, {.soft_m = 0.03});
    for (const double s : {-1.0, 1.0}) {
      const double end = looks.long_hair ? 0.15 : 0.005;
      f.lobe({s * 0.068, -0.045, 0.0}, {s * (looks.long_hair ? 0.084 : 0.07), end, looks.long_hair ? 0.03 : 0.004}, 0.023,
             looks.long_hair ? 0.03 : 0.011, {.soft_m = 0.02});
    }
    if (looks.long_hair)
      f.lobe({0, 0.0, 0.06}, {0, 0.17, 0.06}, 0.07, 0.062, {.flat = 1.4, .soft_m = 0.03});
    else
      f.lobe({0, 0.0, 0.062}, {0, 0.05, 0.05}, 0.056, 0.042, {.soft_m = 0.03});
    put(f, material);
  }

  void shirt(int material) const {
    Flesh f(bones.scale, looks.girth);
    f.on(bones.person_from_torso, {});
    constexpr double kHem_m = -0.865;
    f.lobe({0, -1.31, -0.008}, {0, -1.14, 0.0}, 0.164, 0.152, {.flat = 1.42});
    f.lobe({0, -1.14, 0.0}, {0, -0.9, 0.004}, 0.15, 0.18, {.flat = 1.36, .soft_m = 0.05, .cut_m = 1.14 + kHem_m});
    f.lobe({-0.125, -1.412, 0.012}, {0.125, -1.412, 0.012}, 0.062, 0.062, {.flat = 1.0, .soft_m = 0.07});
    f.lobe({0, -1.44, 0.016}, {0, -1.487, 0.013}, 0.085, 0.066, {.flat = 1.1, .soft_m = 0.05, .cut_m = 0.052});
    for (const double s : {-1.0, 1.0}) f.ball({s * 0.072, -1.31, -0.065}, 0.075, {.flat = 1.3, .soft_m = 0.06});
    for (int side = 0; side < 2; ++side) {
      f.on(bones.arms[side].person_from_upper, rest.upper_arm(side));
      const double end = looks.long_sleeves ? kUpperArm_m - 0.04 : 0.205;
      f.lobe({0, 0.0, 0}, {0, end, 0}, 0.064, looks.long_sleeves ? 0.052 : 0.06,
             {.soft_m = 0.05, .cut_m = looks.long_sleeves ? kNoCut : end});
    }
    put(f, material);
    if (!looks.long_sleeves) return;
    for (int side = 0; side < 2; ++side) {
      Flesh sleeve(bones.scale);
      sleeve.on(bones.arms[side].person_from_upper, rest.upper_arm(side));
      sleeve.lobe({0, 0.15, 0}, {0, kUpperArm_m, 0}, 0.055, 0.05);
      sleeve.on(bones.arms[side].person_from_lower, rest.forearm(side));
      sleeve.lobe({0, 0, 0}, {0, 0.25, 0}, 0.05, 0.039, {.soft_m = 0.025, .cut_m = 0.245});
      put(sleeve, material);
    }
  }

  void trousers(int material) const {
    Flesh f(bones.scale, looks.girth);
    f.on(bones.person_from_torso, {});
    f.lobe({0, -0.99, 0.004}, {0, -0.9, 0.008}, 0.14, 0.142, {.flat = 1.36});
    for (int side = 0; side < 2; ++side) {
      f.on(bones.legs[side].person_from_upper, rest.thigh(side));
      f.lobe({0, 0.01, 0}, {0, kThigh_m, 0}, 0.084, 0.064, {.soft_m = 0.045});
      f.on(bones.legs[side].person_from_lower, rest.shin(side));
      f.lobe({0, 0, 0}, {0, 0.38, 0}, 0.064, 0.055, {.soft_m = 0.035, .cut_m = 0.38});
    }
    put(f, material);
  }

  void shoes(int material) const {
    for (int side = 0; side < 2; ++side) {
      Flesh f(bones.scale);
      f.on(bones.legs[side].person_from_end, {});
      f.lobe({0, 0.045, 0.02}, {outwards(side) * 0.03, 0.06, -0.13}, 0.046, 0.036, {.flat = 1.2, .thin = {0, 1, 0}});
      put(f, material);
    }
  }

  void arm(int side, int material) const {
    Flesh f(bones.scale);
    f.on(bones.arms[side].person_from_upper, rest.upper_arm(side));
    if (!looks.long_sleeves) f.lobe({0, 0.02, 0}, {0, kUpperArm_m, 0}, 0.049, 0.039);
    f.on(bones.arms[side].person_from_lower, rest.forearm(side));
    if (!looks.long_sleeves) f.lobe({0, 0, 0}, {0, 0.09, -0.003}, 0.038, 0.0415, {.soft_m = 0.025});
    const double bare_m = looks.long_sleeves ? 0.17 : 0.09;
    f.lobe({0, bare_m, -0.003}, {0, kForearm_m, 0}, looks.long_sleeves ? 0.034 : 0.0405, 0.0255, {.soft_m = 0.03});
    hand(f, side);
    put(f, material);
  }

  // y towards the fingers, z out of the palm.
  void hand(Flesh& f, int side) const {
    f.on(bones.arms[side].person_from_end, rest.hand(side));
    f.lobe({0, 0.012, 0}, {0, 0.066, 0}, 0.029, 0.039, {.flat = 2.3, .soft_m = 0.025});
    constexpr std::array<double, 4> kRadii_m = {0.0098, 0.0102, 0.0097, 0.0088};
    const Fingers& fingers = bones.fingers[side];
    for (std::size_t i = 0; i < kRadii_m.size(); ++i) {
      const Finger& finger = fingers[1 + i];
      f.lobe(finger.root_m, finger.bend_m, kRadii_m[i], 0.93 * kRadii_m[i], {.soft_m = 0.009});
      f.lobe(finger.bend_m, finger.tip_m, 0.93 * kRadii_m[i], 0.78 * kRadii_m[i], {.soft_m = 0.005});
    }
    const Finger& thumb = fingers[0];
    f.lobe(thumb.root_m, thumb.bend_m, 0.0165, 0.0135, {.soft_m = 0.02});
    f.lobe(thumb.bend_m, thumb.tip_m, 0.0125, 0.0092, {.soft_m = 0.008});
  }
};

}  // namespace

void add_figure(Scene& scene, const Rigid3& world_from_person, const Bones& skeleton, const Looks& looks) {
  const Dresser dresser{scene, world_from_person, skeleton, looks};
  dresser.head(scene.add(looks.face));
  dresser.hair(scene.add(looks.hair));
  dresser.shirt(scene.add(looks.shirt));
  dresser.trousers(scene.add(looks.trousers));
  dresser.shoes(scene.add(looks.shoes));
  const int skin = scene.add(looks.skin);
  for (int side = 0; side < 2; ++side) dresser.arm(side, skin);
}

Looks looks_of(std::uint32_t seed) {
  Random random(seed ^ 0x9e0b1eU);
  const std::uint32_t style = seed - 1;
  constexpr std::array<std::uint32_t, 4> kSkin = {0xe6b08c, 0xd9a07c, 0xa9714c, 0x7d5238};
  constexpr std::array<std::uint32_t, 4> kHair = {0x5a3a22, 0x2a1c14, 0x1a1412, 0x8a5a2c};
  struct Shirt {
    Texture texture;
    std::uint32_t a, b, c;
    double scale_m;
    bool long_sleeves;
  };
  constexpr std::array<Shirt, 4> kShirts = {{{Texture::kPrint, 0x2f62b4, 0xf2c14a, 0xf2efe4, 0.1, false},
                                             {Texture::kStripes, 0xe9e4d8, 0x27406e, 0xb03a34, 0.052, true},
                                             {Texture::kPlaid, 0x9c2f2c, 0x1f2a38, 0xe8d9b0, 0.075, true},
                                             {Texture::kStripes, 0x2f7a64, 0xece2c6, 0x1f3a44, 0.07, false}}};
  const Shirt& shirt = kShirts[style % 4];
  const std::uint32_t tone = (style / 2 + style) % 4;
  const Color skin = srgb(kSkin[tone]), hair = srgb(tone >= 2 ? kHair[1 + style % 2] : kHair[(style * 3) % 4]);
  const Color lips{0.78F * skin.r, 0.42F * skin.g, 0.42F * skin.b};
  Looks out;
  out.scale = random.uniform(0.975, 1.025);
  out.long_sleeves = shirt.long_sleeves;
  out.long_hair = style % 4 == 1;
  const double beard = style % 4 == 2 ? 0.8 : 0.0;
  // The beard's strength travels as the face's scale.
  out.face = {.texture = Texture::kFace, .a = skin, .b = hair, .c = lips, .scale_m = beard, .gloss = 0.05};
  out.skin = {.texture = Texture::kSkin, .a = skin, .gloss = 0.05};
  out.hair = {.texture = Texture::kHair, .a = hair, .b = 0.4 * hair, .gloss = 0.12};
  out.shirt = {.texture = shirt.texture, .a = srgb(shirt.a), .b = srgb(shirt.b), .c = srgb(shirt.c), .scale_m = shirt.scale_m};
  out.trousers = {.texture = Texture::kDenim, .a = srgb(style % 2 == 0 ? 0x4a6488 : 0x3a3d46), .b = srgb(0xc2ccd8)};
  out.shoes = {.texture = Texture::kSpeckle, .a = srgb(0x3a2a22), .b = srgb(0x5a4638), .gloss = 0.2};
  return out;
}

Looks passer_by_of(std::uint32_t seed) {
  Random random(seed ^ 0x9a55b1U);
  constexpr std::array<Texture, 4> kWeaves = {Texture::kPrint, Texture::kStripes, Texture::kPlaid, Texture::kKnit};
  constexpr std::array<std::uint32_t, 8> kColors = {0x8c2f39, 0x2b4162, 0x3f6b4c, 0xd8c9a8,
                                                    0x5d4a66, 0x2a2a2e, 0xc07a3a, 0xb9c4cc};
  Looks out = looks_of(random.bits());
  out.scale = random.uniform(0.9, 1.06);
  out.girth = random.uniform(0.93, 1.12);
  out.shirt.texture = kWeaves[random.pick(4)];
  out.shirt.a = srgb(kColors[random.pick(8)]);
  out.shirt.b = srgb(kColors[random.pick(8)]);
  out.shirt.c = srgb(kColors[random.pick(8)]);
  out.shirt.scale_m = random.uniform(0.04, 0.1);
  out.trousers.a = srgb(kColors[random.pick(8)]);
  return out;
}

}  // namespace duo::synthetic
