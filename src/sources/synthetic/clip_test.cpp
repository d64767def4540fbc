// The synthetic person: shapes by hand, a truth that agrees with the pictures, scripts that do what they say.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <map>
#include <thread>

#include "core/lens.h"
#include "duoptic/source.h"
#include "duoptic/synthetic.h"
#include "sources/synthetic/blend.h"
#include "sources/synthetic/figure.h"
#include "sources/synthetic/noise.h"
#include "sources/synthetic/script.h"
#include "tests/write_media.h"

namespace duo {
namespace {

using namespace synthetic;
namespace fs = std::filesystem;

constexpr Size kSmall{160, 120}, kTiny{64, 48};

SyntheticClip open(const std::string& script, std::uint32_t seed, Size size, int threads = 2,
                   SyntheticArm arm = SyntheticArm::kRight) {
  auto clip = SyntheticClip::open({.size = size, .seed = seed, .script = script, .arm = arm}, threads);
  EXPECT_TRUE(clip.has_value()) << clip.error().what;
  return std::move(*clip);
}

const SyntheticJoint& joint(const SyntheticClipFrame& frame, const std::string& name) {
  for (const SyntheticJoint& j : frame.joints)
    if (name_of(j.id) == name) return j;
  ADD_FAILURE() << name;
  return frame.joints.front();
}

std::string pixels(const Image<Rgb8>& image) {
  std::string out;
  for (int y = 0; y < image.height(); ++y) out.append(reinterpret_cast<const char*>(image.row(y)), 3 * image.width());
  return out;
}

// --- Shapes --------------------------------------------------------------------------------------------------------------

TEST(SyntheticBlend, EnteredWhereGeometrySays) {
  // A ball of 0.5, and a capsule from (0, 0, 0) to (0, 1, 0) twice as thin along z.
  const Blend ball({Lobe{.from_m = 0.5, .to_m = 0.5}});
  EXPECT_NEAR(ball.enter({0, 0, -2}, {0, 0, 1}, 0), 1.5, 4e-6);
  EXPECT_NEAR(ball.enter({0.3, 0, -2}, {0, 0, 2}, 0), 0.8, 4e-6);
  EXPECT_EQ(ball.enter({0.51, 0, -2}, {0, 0, 1}, 0), std::numeric_limits<double>::infinity());
  EXPECT_EQ(ball.enter({0, 0, 0}, {0, 0, 1}, 0), std::numeric_limits<double>::infinity());
  const Blend flat({Lobe{.length_m = 1, .from_m = 0.5, .to_m = 0.5, .flat = 2}});
  EXPECT_NEAR(flat.enter({0, 0.5, -2}, {0, 0, 1}, 0), 1.75, 4e-6);
  EXPECT_NEAR(flat.enter({-2, 0.5, 0}, {1, 0, 0}, 0), 1.5, 4e-6);
  EXPECT_NEAR(flat.enter({0.3, 0.5, -2}, {0, 0, 1}, 0), 1.8, 4e-6);  // ellipse: z = 0.5 / 2 * sqrt(1 - 0.6^2)
  // Cut at y = 0.6: from below the ray meets the cut, not the cap.
  const Blend cut({Lobe{.length_m = 1, .from_m = 0.5, .to_m = 0.5, .cut_m = 0.6}});
  EXPECT_NEAR(cut.enter({0.1, 3, 0}, {0, -1, 0}, 0), 2.4, 4e-6);
  const Vec3 n = flat.normal({0, 0.5, -0.25});
  EXPECT_NEAR(n.z, -1, 1e-6);
}

TEST(SyntheticBlend, SeamIsSoftAndFarLobesChangeNothing) {
  const Rigid3 aside{{}, {0.3, 0, 0}}, far{{}, {2, 0, 0}};
  const Blend two(
      {Lobe{.from_m = 0.2, .to_m = 0.2}, Lobe{.blend_from_lobe = aside, .from_m = 0.2, .to_m = 0.2, .soft_m = 0.1}});
  // Half way both distances are sqrt(0.15^2 + z^2) - 0.2; smoothed they fall by a quarter of 0.1: z^2 = 0.225^2 - 0.15^2.
  EXPECT_NEAR(two.enter({0.15, 0, -1}, {0, 0, 1}, 0), 1 - std::sqrt(0.225 * 0.225 - 0.15 * 0.15), 4e-6);
  const Blend apart(
      {Lobe{.from_m = 0.2, .to_m = 0.2}, Lobe{.blend_from_lobe = far, .from_m = 0.2, .to_m = 0.2, .soft_m = 0.1}});
  EXPECT_NEAR(apart.enter({0, 0, -1}, {0, 0, 1}, 0), 0.8, 4e-6);
  EXPECT_NEAR(apart.enter({2, 0, -1}, {0, 0, 1}, 0), 0.8, 4e-6);
  EXPECT_TRUE(apart.blocks({2, 0, -1}, {0, 0, 1}));
  EXPECT_FALSE(apart.blocks({2, 0, -1}, {0, 0, 0.7}));
  EXPECT_FALSE(apart.blocks({1, 0, -1}, {0, 0, 3}));
}

// Where a march over the whole of a figure's solids, in small steps, first finds one inside, the ray enters.
TEST(SyntheticBlend, NothingIsSkipped) {
  Scene scene;
  const Script script(acts_of("reach"), kRightSide, 1);
  add_figure(scene, {}, make_bones(script.at(1.2).pose, 1), looks_of(1));
  scene.ready();
  Random random(3);
  int hits = 0;
  for (int i = 0; i < 300; ++i) {
    const double x = random.uniform(-0.4, 0.4), y = random.uniform(-1.8, -0.3);
    const Ray ray{{0.3 * x, -1.2, -2}, Vec3{0.7 * x, y + 1.2, 2}};
    const Hit hit = scene.trace(ray);
    constexpr double kStep = 1.0 / 2000;
    bool found = false;
    for (double t = 0; t < std::min(hit.t - 2 * kStep, 1.5) && !found; t += kStep) {
      const Ray rest{ray.origin + t * ray.direction, ray.direction};
      for (int s = 0; s < static_cast<int>(scene.shapes.size()); ++s) {
        // From outside, an entry behind the first one found would be new.
        const double from_here = t + scene.trace(rest, s);
        found = found || from_here < hit.t - 1e-4;
      }
    }
    EXPECT_FALSE(found) << i;
    hits += hit.shape >= 0;
  }
  EXPECT_GT(hits, 60);
}

// --- Truth ---------------------------------------------------------------------------------------------------------------

TEST(SyntheticPerson, TruthAgreesWithLensAndDepth) {
  for (const std::uint32_t seed : {1U, 2U}) {
    SyntheticClip clip = open("tour", seed, kSmall);
    const Lens left(clip.rig().left), right(clip.rig().right);
    int visible = 0;
    for (int i = 0; i < clip.setup().frames; i += 61) {
      const SyntheticClipFrame frame = clip.frame(i);
      ASSERT_EQ(frame.joints.size(), 49U);
      for (const SyntheticJoint& j : frame.joints) {
        EXPECT_TRUE(!j.visible_left || j.in_left);
        if (j.uv_left_px) {
          const auto at = left.pixel_of(j.p_in_left_m);
          ASSERT_TRUE(at.has_value());
          EXPECT_NEAR(at->x, (*j.uv_left_px)[0], 1e-6);
          EXPECT_NEAR(at->y, (*j.uv_left_px)[1], 1e-6);
        }
        if (j.uv_right_px) {
          const auto at = right.pixel_of(clip.rig().right_from_left * j.p_in_left_m);
          ASSERT_TRUE(at.has_value());
          EXPECT_NEAR(at->x, (*j.uv_right_px)[0], 1e-6);
        }
        if (!j.in_left) continue;
        const int x = static_cast<int>((*j.uv_left_px)[0] + 0.5), y = static_cast<int>((*j.uv_left_px)[1] + 0.5);
        if (x < 1 || y < 1 || x > kSmall.width - 2 || y > kSmall.height - 2) continue;
        // Inside the person, all pixels around see about what the ray to the joint sees.
        bool inside = j.surface_z_left_m.has_value();
        float low = 1e9F, high = 0;
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) {
            inside = inside && frame.figure_left.at(y + dy, x + dx) == 255;
            low = std::min(low, frame.depth_left_m.at(y + dy, x + dx));
            high = std::max(high, frame.depth_left_m.at(y + dy, x + dx));
          }
        if (!inside) continue;
        // Between pixel centres a round thing (the tip of the nose) can stand out by a part of the relief around.
        const float slack = 0.001F + 0.25F * (high - low);
        EXPECT_GT(*j.surface_z_left_m, low - slack) << name_of(j.id) << " frame " << i;
        EXPECT_LT(*j.surface_z_left_m, high + slack) << name_of(j.id) << " frame " << i;
        if (j.visible_left) {
          ++visible;
          EXPECT_LT(*j.surface_z_left_m, j.p_in_left_m.z + 1e-6) << name_of(j.id) << ": a joint lies inside the body";
        }
      }
    }
    EXPECT_GT(visible, 60);
  }
}

// A wrist raised before the wall lies in the middle of the arm that the picture shows.
TEST(SyntheticPerson, JointsLieInTheMiddleOfTheirLimb) {
  for (const auto& [script, index] : {std::pair{"wave", 29}, std::pair{"sweep", 29}}) {
    SyntheticClip clip = open(script, 1, {320, 240});
    const SyntheticClipFrame frame = clip.frame(index);
    const auto elbow = *joint(frame, "right_elbow").uv_left_px, wrist = *joint(frame, "right_wrist").uv_left_px;
    const double length = std::hypot(wrist[0] - elbow[0], wrist[1] - elbow[1]);
    ASSERT_GT(length, 20);
    const double ax = -(wrist[1] - elbow[1]) / length, ay = (wrist[0] - elbow[0]) / length;
    const auto reach = [&](double sign) {
      double r = 0;
      while (frame.figure_left.at(static_cast<int>(wrist[1] + sign * r * ay + 0.5),
                                  static_cast<int>(wrist[0] + sign * r * ax + 0.5)) == 255)
        r += 0.25;
      return r;
    };
    const double one = reach(1), other = reach(-1);
    EXPECT_NEAR(one, other, 1.6) << script;  // a pixel's rounding, and the hand that bends away
    EXPECT_GT(one + other, 4) << script;
    EXPECT_LT(one + other, 14) << script;
  }
}

TEST(SyntheticPerson, BonesKeepTheirLengths) {
  for (const std::string& name : act_names()) {
    const Script script(acts_of(name), kLeftSide, 5);
    for (double t = 0; t < script.length_s(); t += 0.05) {
      const Bones bones = make_bones(script.at(t).pose, 1.02);
      for (const Limb& arm : bones.arms) {
        EXPECT_NEAR(norm(arm.middle_m - arm.root_m), 1.02 * kUpperArm_m, 1e-12);
        EXPECT_NEAR(norm(arm.end_m - arm.middle_m), 1.02 * kForearm_m, 1e-12);
      }
      for (const Limb& leg : bones.legs) EXPECT_NEAR(norm(leg.middle_m - leg.root_m), 1.02 * kThigh_m, 1e-12);
      EXPECT_NEAR(norm(bones.hands_m[0] - bones.arms[0].end_m), 1.02 * kPalm_m, 1e-12);
    }
  }
}

// An adult's arm: below 4 m/s, and no jumps.
TEST(SyntheticPerson, MovesSmoothly) {
  for (const std::string& name : synthetic_scripts()) {
    const Script script(acts_of(name), kRightSide, 1);
    Vec3 hand_before, foot_before;
    for (int i = 0; i < script.length_s() * 30; ++i) {
      const Script::Moment moment = script.at(i / 30.0);
      const Bones bones = make_bones(moment.pose, 1);
      const Vec3 hand = moment.stage_from_person * bones.hands_m[kRightSide], foot = moment.stage_from_person * bones.feet_m[0];
      if (i > 0) {
        EXPECT_LT(norm(hand - hand_before) * 30, 4) << name << i;
        EXPECT_LT(norm(foot - foot_before) * 30, 5) << name << i;
      }
      hand_before = hand;
      foot_before = foot;
    }
  }
}

/// Tips that meet touch skin to skin, whichever hand; open they are a hand's breadth apart.
TEST(SyntheticPerson, PinchesWithThumbAndIndexFinger) {
  for (const int side : {kRightSide, kLeftSide}) {
    const auto apart_m = [side](double pinch) {
      ArmPose arm;
      arm.pinch = pinch;
      const Fingers fingers = make_fingers(arm, side);
      return norm(fingers[0].tip_m - fingers[1].tip_m);
    };
    EXPECT_NEAR(apart_m(1), 0.015, 0.003);
    EXPECT_GT(apart_m(0), 0.06);
    EXPECT_LT(apart_m(0.5), apart_m(0));
  }
}

TEST(SyntheticPerson, StartsWithTheWholeArmInSight) {
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    SyntheticClip clip = open("tour", seed, kTiny, 2, SyntheticArm::kBySeed);
    const std::string side = clip.setup().arm == SyntheticArm::kLeft ? "left_" : "right_";
    const SyntheticClipFrame frame = clip.frame(0);
    for (const char* name : {"shoulder", "elbow", "hand"}) {
      EXPECT_TRUE(joint(frame, side + name).visible_left) << seed << name;
      EXPECT_TRUE(joint(frame, side + name).visible_right) << seed << name;
    }
    const double z = joint(frame, "pelvis").p_in_left_m.z;
    EXPECT_GT(z, 1.5);
    EXPECT_LT(z, 2.2);
  }
}

TEST(SyntheticPerson, HidesLeavesReachesAndDims) {
  const auto count = [](SyntheticClip clip, auto&& holds) {
    int frames = 0;
    for (int i = 0; i < clip.setup().frames; i += 4) frames += holds(clip.frame(i)) ? 4 : 0;
    return frames;
  };
  for (const auto& [arm, hand] : {std::pair{SyntheticArm::kRight, "right_hand"}, std::pair{SyntheticArm::kLeft, "left_hand"}}) {
    const auto hidden = [&, name = hand](const SyntheticClipFrame& f) {
      return joint(f, name).in_left && !joint(f, name).visible_left && !joint(f, name).visible_right;
    };
    const int behind = count(open("behind", 1, kTiny, 2, arm), hidden);
    EXPECT_GE(behind, 12);
    EXPECT_LE(behind, 50);
    const int gone = count(open("out", 1, kTiny, 2, arm), [&, name = hand](const SyntheticClipFrame& f) {
      return !joint(f, name).in_left && !joint(f, name).in_right;
    });
    EXPECT_GE(gone, 8);
    EXPECT_LE(gone, 50);
  }
  EXPECT_GE(count(open("reach", 1, kTiny),
                  [](const SyntheticClipFrame& f) {
                    return joint(f, "right_hand").p_in_left_m.z < joint(f, "right_shoulder").p_in_left_m.z - 0.4;
                  }),
            8);
  EXPECT_GE(count(open("light", 1, kTiny), [](const SyntheticClipFrame& f) { return f.ceiling_light < 0.5; }), 20);
  EXPECT_EQ(count(open("wave", 1, kTiny), [](const SyntheticClipFrame& f) { return f.ceiling_light < 1; }), 0);
}

TEST(SyntheticPerson, LampDimsThePicture) {
  SyntheticClip clip = open("light", 1, kTiny);
  const auto mean = [&](int index) {
    const SyntheticClipFrame frame = clip.frame(index);
    double sum = 0;
    for (const char c : pixels(frame.pair.left.pixels)) sum += static_cast<unsigned char>(c);
    return sum / (3 * kTiny.width * kTiny.height);
  };
  EXPECT_LT(mean(54), 0.92 * mean(0));
  EXPECT_NEAR(mean(clip.setup().frames - 1), mean(0), 2);
}

// --- Clips ---------------------------------------------------------------------------------------------------------------

TEST(SyntheticClip, SameBitsWithAnyNumberOfThreadsAndInAnyOrder) {
  SyntheticClip one = open("sweep", 4, kTiny, 1), two = open("sweep", 4, kTiny, 2);
  const SyntheticClipFrame later = two.frame(40);
  for (const int i : {7, 40}) {
    const SyntheticClipFrame a = one.frame(i), b = two.frame(i);
    EXPECT_EQ(pixels(a.pair.left.pixels), pixels(b.pair.left.pixels)) << i;
    EXPECT_EQ(pixels(a.pair.right.pixels), pixels(b.pair.right.pixels)) << i;
    for (int y = 0; y < kTiny.height; ++y)
      EXPECT_EQ(std::memcmp(a.depth_left_m.row(y), b.depth_left_m.row(y), sizeof(float) * kTiny.width), 0);
  }
  EXPECT_EQ(pixels(later.pair.left.pixels), pixels(one.frame(40).pair.left.pixels));
  EXPECT_NE(pixels(later.pair.left.pixels), pixels(open("sweep", 3, kTiny).frame(40).pair.left.pixels));
}

TEST(SyntheticClip, RefusesWhatCannotBe) {
  const auto refused = [](const SyntheticClipSetup& setup) {
    const auto clip = SyntheticClip::open(setup, 1);
    return clip.has_value() ? std::string() : clip.error().what;
  };
  EXPECT_NE(refused({.script = "dance"}).find("no script 'dance'; choose one of wave"), std::string::npos);
  EXPECT_NE(refused({.size = {0, 48}}).find("0x48"), std::string::npos);
  EXPECT_NE(refused({.size = {64, 48}, .frames = -1}).find("-1 frames"), std::string::npos);
}

TEST(SyntheticClip, IsAnySize) {
  for (const Size size : {Size{1, 1}, Size{33, 17}, Size{17, 33}, Size{128, 72}}) {
    SyntheticClip clip = open("wave", 1, size);
    EXPECT_EQ(clip.frame(3).pair.left.pixels.size(), size);
  }
}

/// The first time each pair comes when it is rendered, in order; then all come at the rate of cameras, the newest first, over
/// and over. The next time they are kept, and come at that rate at once.
TEST(SyntheticClip, Live) {
  const test::TempFolder cache;
  ASSERT_EQ(setenv("XDG_CACHE_HOME", (cache / "").c_str(), 1), 0);
  const SyntheticClipSetup setup{.size = kTiny, .script = "wave"};
  auto clip = SyntheticClip::open(setup, 2);
  const auto expected = [&](const Pair& pair) {
    const auto turn = static_cast<int>(pair.sequence % 18);
    return clip->frame(std::min(turn, 18 - turn)).pair;
  };
  for (const bool kept : {false, true}) {
    SCOPED_TRACE(kept);
    const auto source = open_pairs("synthetic:wave:64x48:10", "");
    ASSERT_TRUE(source) << source.error().what;
    EXPECT_TRUE((*source)->live());
    EXPECT_EQ((*source)->rig()->left.fx_px, clip->rig().left.fx_px);
    Pair pair;
    std::uint64_t first = 0;
    TimeNs before_ns = 0;
    for (int i = 0; i < 10; ++i) {
      Result<Next> next = (*source)->next(pair);
      while (next && *next == Next::kNothing) next = (*source)->next(pair);
      ASSERT_TRUE(next && *next == Next::kNew);
      EXPECT_EQ(pixels(pair.right.pixels), pixels(expected(pair).right.pixels));
      EXPECT_GT(pair.left.t_ns, before_ns);
      EXPECT_TRUE(i == 0 || pair.sequence > first);
      first = pair.sequence;
      before_ns = pair.left.t_ns;
    }
    while (!(*source)->warning().empty()) ASSERT_TRUE((*source)->next(pair));
    ASSERT_EQ(*(*source)->next(pair), Next::kNew);
    const TimeNs start_ns = pair.left.t_ns;
    const std::uint64_t start = pair.sequence;
    const std::int64_t dropped = (*source)->dropped();
    std::this_thread::sleep_for(std::chrono::milliseconds(430));
    ASSERT_EQ(*(*source)->next(pair), Next::kNew);
    ASSERT_GE(pair.sequence, start + 12);
    EXPECT_EQ((*source)->dropped() - dropped, static_cast<std::int64_t>(pair.sequence - start) - 1);
    EXPECT_NEAR(static_cast<double>(pair.left.t_ns - start_ns), static_cast<double>(pair.sequence - start) * 1e9 / 30, 100);
    EXPECT_EQ(pixels(pair.left.pixels), pixels(expected(pair).left.pixels));
    const auto file = cache / "duoptic/synthetic-wave-64x48-10";
    for (int i = 0; i < 1000 && !std::filesystem::exists(file); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_GT(std::filesystem::file_size(file), 2u * 10 * 3 * 64 * 48);
  }
  unsetenv("XDG_CACHE_HOME");
}

TEST(SyntheticClip, LiveRefusesWhatCannotBe) {
  for (const auto& [name, words] : std::map<std::string, std::string>{{"synthetic:dance", "no script 'dance'"},
                                                                      {"synthetic:wave:64", "not WIDTHxHEIGHT"},
                                                                      {"synthetic:wave:64x48x3", "not WIDTHxHEIGHT"},
                                                                      {"synthetic:wave:64x48:", "not WIDTHxHEIGHT"},
                                                                      {"synthetic:wave:64x48:1", "choose 2 to"},
                                                                      {"synthetic:wave:0x48", "0x48"}}) {
    const auto source = open_pairs(name, "");
    ASSERT_FALSE(source) << name;
    EXPECT_NE(source.error().what.find(words), std::string::npos) << source.error().what;
  }
}

}  // namespace
}  // namespace duo
