#include "stages/mark_targets/mark_targets.h"

#include <vector>

#include "tests/targets.h"
#include "tests/time.h"

namespace duo {
namespace {

struct Scene {
  Image<std::uint8_t> hue, saturation, value;
  std::vector<Target> targets;

  MarkTargets input() const { return {hue, saturation, value, targets}; }
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

// By hand: the window reaches from outside to column 4, and bit 2 is the third target's.
TEST(MarkTargets, Window) {
  Scene scene = scene_of({15, 16, 23, 24, 20, 20});
  Target target;
  target.color = {20, 4, 0, 0};
  target.window = {-3, 0, 8, 5};
  scene.targets = {Target{}, Target{}, target};
  expect_marks(scene, {0, 4, 4, 4, 4, 0});
}

TEST(MarkTargets, SimdAgrees) {
  std::mt19937 rng(6);
  Pool one(1), two(2), three(3);
  for (const Size size : test::awkward_sizes())
    for (int round = 0; round < 12; ++round) {
      test::Tight<std::uint8_t> hue(size), saturation(size), value(size), want(size);
      test::fill(hue.view, test::Fill::kRandom, rng);
      test::fill(saturation.view, test::Fill::kRandom, rng);
      test::fill(value.view, test::Fill::kRandom, rng);
      std::vector<Target> targets(rng() % (kMaxTargets + 1));
      for (Target& target : targets) target = test::random_target(rng, size);
      const MarkTargets in{hue.view, saturation.view, value.view, targets};
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
  Target target;
  target.window = Window::all(size);
  Image<std::uint8_t> marks(size);
  Pool one(1);
  const auto time = [&](const char* what) {
    test::print_time(what, size, [&] { simd::mark_targets(one, scene.input(), marks); });
  };
  scene.targets.assign(1, target);
  time("mark_targets, 1 hue");
  scene.targets.assign(6, target);
  time("mark_targets, 6 hues");
  for (Target& each : scene.targets) each.window = {300, 200, 120, 120};
  time("mark_targets, 6 hues, 120x120");
}

}  // namespace
}  // namespace duo
