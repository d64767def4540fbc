#include "stages/mark_targets/mark_targets.h"

#include <vector>

#include "tests/targets.h"
#include "tests/time.h"

namespace duo {
namespace {

using test::kNone;

struct Scene {
  Image<std::uint8_t> hue, saturation, value;
  Image<std::uint16_t> d_q4, background_q4;
  std::vector<Target> targets;
  std::vector<ColorLikelihood> likelihoods;

  MarkTargets input() const { return {hue, saturation, value, d_q4, background_q4, targets, likelihoods}; }
  Image<std::uint8_t> marks() const {
    Image<std::uint8_t> out(hue.size());
    ref::mark_targets(input(), out);
    return out;
  }
};

Scene scene_of(std::initializer_list<int> hue) {
  Scene scene;
  scene.hue = test::image<std::uint8_t>({hue});
  scene.saturation = test::constant<std::uint8_t>(scene.hue.size(), 100);
  scene.value = test::constant<std::uint8_t>(scene.hue.size(), 100);
  return scene;
}

void expect_marks(const Scene& scene, std::initializer_list<int> want) {
  test::expect_same<std::uint8_t>(test::image<std::uint8_t>({want}), scene.marks(), "marks");
}

// By hand: 250 + 10 = 260 = 4 around the circle, so 240 and 4 are the last hues within; bit 1 wants brighter pixels than there
// are.
TEST(MarkTargets, HueAroundTheCircle) {
  Scene scene = scene_of({239, 240, 250, 255, 0, 4, 5, 122});
  Target red;
  red.color = {250, 10, 100, 100};
  red.window = Window::all(scene.hue.size());
  Target bright = red;
  bright.color.min_value = 101;
  scene.targets = {red, bright};
  expect_marks(scene, {0, 1, 1, 1, 1, 1, 0, 0});
  scene.targets[0].color.hue_tolerance = 128;
  expect_marks(scene, {1, 1, 1, 1, 1, 1, 1, 1});
  scene.targets[0].color.min_saturation = 101;
  expect_marks(scene, {0, 0, 0, 0, 0, 0, 0, 0});
}

// By hand: bin of (16..23, 96..103) is 2 * 32 + 12.
TEST(MarkTargets, LikelihoodAndWindow) {
  Scene scene = scene_of({15, 16, 23, 24, 20, 20});
  scene.likelihoods.resize(2);
  scene.likelihoods[1][2 * 32 + 12] = 200;
  Target skin;
  skin.color.likelihood = 1;
  skin.color.min_likelihood = 200;
  skin.window = {-3, 0, 8, 5};  // columns 0 .. 4
  scene.targets = {Target{}, Target{}, skin};
  expect_marks(scene, {0, 4, 4, 0, 4, 0});
  scene.targets[2].color.min_likelihood = 201;
  expect_marks(scene, {0, 0, 0, 0, 0, 0});
}

// By hand: gate 100 .. 200, background 150 with tolerance 20: 130 and 170 are background, 129 and 171 are not. Bit 1 lets
// pixels without disparity pass; where the background is not known it takes nothing away.
TEST(MarkTargets, DepthGate) {
  Scene scene = scene_of({0, 0, 0, 0, 0, 0, 0, 0});
  scene.d_q4 = test::image<std::uint16_t>({{99, 100, 129, 130, 170, 171, 201, kNone}});
  Target target;
  target.gate = {100, 200, 20, false};
  target.window = Window::all(scene.hue.size());
  Target lenient = target;
  lenient.gate = {100, 200, -1, true};
  scene.targets = {target, lenient};
  expect_marks(scene, {0, 3, 3, 3, 3, 3, 0, 2});
  scene.background_q4 = test::constant<std::uint16_t>(scene.hue.size(), 150);
  scene.background_q4.at(0, 4) = kNone;
  expect_marks(scene, {0, 3, 3, 2, 3, 3, 0, 2});
  scene.d_q4 = {};
  expect_marks(scene, {2, 2, 2, 2, 2, 2, 2, 2});
}

TEST(MarkTargets, SimdAgrees) {
  std::mt19937 rng(6);
  Pool one(1), two(2), three(3);
  for (const Size size : test::awkward_sizes())
    for (int round = 0; round < 12; ++round) {
      test::Tight<std::uint8_t> hue(size), saturation(size), value(size), want(size);
      test::Tight<std::uint16_t> d(size), background(size);
      test::fill(hue.view, test::Fill::kRandom, rng);
      test::fill(saturation.view, test::Fill::kRandom, rng);
      test::fill(value.view, test::Fill::kRandom, rng);
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
          d.view.at(y, x) = rng() % 5 == 0 ? kNone : rng() % 20 == 0 ? rng() % kNone : rng() % 1200;
          background.view.at(y, x) = rng() % 5 == 0 ? kNone : rng() % 20 == 0 ? rng() % kNone : rng() % 1200;
        }
      std::vector<ColorLikelihood> likelihoods(2);
      for (auto& table : likelihoods)
        for (auto& bin : table) bin = static_cast<std::uint8_t>(rng());
      std::vector<Target> targets(rng() % (kMaxTargets + 1));
      for (Target& target : targets) target = test::random_target(rng, size, 2);
      MarkTargets in{hue.view, saturation.view, value.view, d.view, background.view, targets, likelihoods};
      if (round % 3 == 1) in.background_q4 = {};
      if (round % 5 == 2) in.d_q4 = {};
      ref::mark_targets(in, want.view);
      test::each_target([&](const std::string& target) {
        for (Pool* pool : {&one, &two, &three}) {
          test::Tight<std::uint8_t> got(size);
          test::fill(got.view, test::Fill::kHigh, rng);
          simd::mark_targets(*pool, in, got.view);
          test::expect_same<std::uint8_t>(want.view, got.view, "mark_targets simd " + target);
        }
      });
      if (HasFailure()) return;
    }
}

TEST(MarkTargets, Time) {
  const Size size{640, 480};
  std::mt19937 rng(7);
  Scene scene;
  for (auto* plane : {&scene.hue, &scene.saturation, &scene.value}) {
    *plane = Image<std::uint8_t>(size);
    test::fill(plane->view(), test::Fill::kRandom, rng);
  }
  scene.d_q4 = test::constant<std::uint16_t>(size, 300);
  scene.background_q4 = test::constant<std::uint16_t>(size, 200);
  scene.likelihoods.resize(2);
  Target target;
  target.window = Window::all(size);
  target.gate.background_tolerance_q4 = 16;
  Image<std::uint8_t> marks(size);
  Pool one(1);
  const auto time = [&](const char* what) {
    test::print_time(what, size, [&] { simd::mark_targets(one, scene.input(), marks); });
  };
  scene.targets.assign(1, target);
  time("mark_targets, 1 hue");
  scene.targets.assign(6, target);
  time("mark_targets, 6 hues");
  for (std::size_t t = 0; t < 6; ++t) scene.targets[t].color.likelihood = t % 2;
  time("mark_targets, 6 tables");
  for (Target& each : scene.targets) each.window = {300, 200, 120, 120};
  time("mark_targets, 6 tables, 120x120");
}

}  // namespace
}  // namespace duo
