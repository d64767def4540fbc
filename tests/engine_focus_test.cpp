// A part of the picture between some disparities: Engine::focus().
#include <algorithm>
#include <string>

#include "engines/focused.h"
#include "tests/agree.h"
#include "tests/allocations.h"
#include "tests/engine_setups.h"

namespace duo {
namespace {

using test::kChoices, test::prepared, test::raw_setup, test::run;

constexpr Size kRoom{160, 96};

SyntheticPair room() {
  SyntheticSetup synthetic;
  synthetic.size = kRoom;
  return render_synthetic(synthetic, 2);
}

TEST(Focus, PartsHaveFewSizesWhereAsked) {
  // 300 px wide at 100: up to 320, four eighths of 640, to the right end; 130 rows: up to 240; 20 disparities: 64, which begin
  // at 0, as 57 - 64 is less.
  FocusPart part = focus_part({{100, 50, 300, 130}, 37, 57}, {640, 480}, 192, true);
  EXPECT_EQ(part.kept, (Window{100, 50, 300, 130}));
  EXPECT_EQ(part.matched, (Window{80, 50, 320, 240}));
  EXPECT_EQ(part.first_disparity, 0);
  EXPECT_EQ(part.disparities, 64);
  // What more is searched lies behind: 100 - 64.
  EXPECT_EQ(focus_part({{100, 50, 300, 130}, 70, 100}, {640, 480}, 192, true).first_disparity, 36);
  // What would reach over the picture and beyond the disparities moves back; the right part is inside the picture, too.
  part = focus_part({{-20, 400, 100, 300}, 170, 400}, {640, 480}, 192, true);
  EXPECT_EQ(part.kept, (Window{0, 400, 80, 80}));
  EXPECT_EQ(part.matched, (Window{0, 360, 80, 120}));
  EXPECT_EQ(part.first_disparity, 0);
  EXPECT_EQ(part.disparities, 192);
  // All there is.
  part = focus_part({{0, 0, 640, 480}, 0, 150}, {640, 480}, 150, true);
  EXPECT_EQ(part.matched, (Window{0, 0, 640, 480}));
  EXPECT_EQ(part.disparities, 150);
  // Else 32 columns, and rows as they are.
  part = focus_part({{100, 50, 300, 130}, 37, 57}, {640, 480}, 192, false);
  EXPECT_EQ(part.kept, (Window{100, 50, 300, 130}));
  EXPECT_EQ(part.matched, (Window{80, 50, 320, 130}));
}

TEST(Focus, OnAllThereIsItIsTheWholeFrame) {
  const SyntheticPair scene = room();
  for (const auto& choice : kChoices) {
    duo::Setup setup = raw_setup(scene, choice);
    setup.fill = false;
    const auto engine = prepared("simd", 2, setup);
    const auto whole = run(*engine, scene.pair);
    engine->focus({Window::all(whole->left.size()), 0, setup.max_disparity});  // rectified it has another size
    const auto same = run(*engine, scene.pair);
    test::expect_same<std::uint16_t>(whole->disparity.d_q4, same->disparity.d_q4, choice.matcher);
    test::expect_same<std::uint16_t>(whole->depth_mm, same->depth_mm, choice.matcher);
  }
}

TEST(Focus, EnginesAgreeAndNothingLiesOutside) {
  const SyntheticPair scene = room();
  const Window window{30, 20, 70, 50};
  for (const auto& choice : kChoices) {
    const std::string who = std::string(choice.matcher) + " " + choice.preset;
    duo::Setup setup = raw_setup(scene, choice);
    setup.max_disparity = 80;
    setup.wants.confidence = choice.matcher == std::string("sgm");
    const auto ref = prepared("ref", 1, setup);
    // The middle half of the disparities that the whole frame finds there.
    const auto whole = run(*ref, scene.pair);
    std::vector<std::uint16_t> found;
    for (int y = window.y; y < window.y_end(); ++y)
      for (int x = window.x; x < window.x_end(); ++x)
        if (whole->disparity.origin.at(y, x) == static_cast<std::uint8_t>(Origin::kMeasured))
          found.push_back(whole->disparity.d_q4.at(y, x));
    ASSERT_GT(found.size(), 1000u) << who;
    std::sort(found.begin(), found.end());
    const Focus focus{window, found[found.size() / 4] / 16 - 2, found[found.size() * 3 / 4] / 16 + 2};
    ASSERT_GT(focus.disparity_begin, 0) << who;

    ref->focus(focus);
    const auto want = run(*ref, scene.pair);
    int like_whole = 0, measured = 0;
    for (int y = 0; y < whole->left.height(); ++y)
      for (int x = 0; x < whole->left.width(); ++x) {
        const std::uint16_t d = want->disparity.d_q4.at(y, x);
        const bool none = d == Disparity::kNone;
        EXPECT_EQ(none, want->disparity.origin.at(y, x) == static_cast<std::uint8_t>(Origin::kNone));
        if (!window.contains(y, x)) {
          ASSERT_TRUE(none) << who << " " << x << "," << y;
          continue;
        }
        if (none) continue;
        ++measured;
        like_whole += std::abs(d - whole->disparity.d_q4.at(y, x)) <= 16;
      }
    EXPECT_GT(measured, window.width * window.height / 3) << who;
    EXPECT_GT(like_whole, measured * 85 / 100) << who;

    for (const int threads : {1, 3}) {
      setup.many_at_once = threads == 3;
      const auto simd = prepared("simd", threads, setup);
      ASSERT_TRUE(simd->can_focus());
      simd->focus(focus);
      const auto got = run(*simd, scene.pair);
      test::expect_same<std::uint16_t>(want->disparity.d_q4, got->disparity.d_q4, who + " disparity");
      test::expect_same<std::uint8_t>(want->disparity.origin, got->disparity.origin, who + " origin");
      test::expect_same<std::uint8_t>(want->confidence, got->confidence, who + " confidence");
      test::expect_same<std::uint16_t>(want->depth_mm, got->depth_mm, who + " depth");
      Focus in_steps = focus;
      in_steps.row_step = 2;
      ref->focus(in_steps);
      simd->focus(in_steps);
      const auto thin = run(*ref, scene.pair), thin_got = run(*simd, scene.pair);
      test::expect_same<std::uint16_t>(thin->disparity.d_q4, thin_got->disparity.d_q4, who + " disparity, every second row");
      test::expect_same<std::uint8_t>(thin->confidence, thin_got->confidence, who + " confidence, every second row");
      int like_all = 0;
      for (int y = window.y; y < window.y_end(); ++y)
        for (int x = window.x; x < window.x_end(); ++x) {
          const std::uint16_t d = thin->disparity.d_q4.at(y, x);
          like_all += d != Disparity::kNone && std::abs(d - want->disparity.d_q4.at(y, x)) <= 16;
        }
      EXPECT_GT(like_all, measured * 85 / 100) << who;
      simd->focus({});
      test::expect_same<std::uint16_t>(whole->disparity.d_q4, run(*simd, scene.pair)->disparity.d_q4, who + " whole again");
    }
  }
}

TEST(Focus, EndsWithPrepare) {
  const SyntheticPair scene = room();
  const duo::Setup setup = raw_setup(scene, kChoices[0]);
  for (const char* name : {"ref", "simd"}) {
    const auto engine = prepared(name, 1, setup);
    const auto whole = run(*engine, scene.pair);
    engine->focus({{30, 20, 70, 50}, 4, 20});
    EXPECT_EQ(run(*engine, scene.pair)->disparity.d_q4.at(0, 0), Disparity::kNone) << name;
    ASSERT_TRUE(engine->prepare(setup));
    test::expect_same<std::uint16_t>(whole->disparity.d_q4, run(*engine, scene.pair)->disparity.d_q4, name);
  }
}

// Nothing is left of the parts before: of larger ones, of more disparities; nor where there are more sizes than are kept.
TEST(Focus, SizesComeBack) {
  const SyntheticPair scene = room();
  for (const auto& choice : kChoices) {
    duo::Setup setup = raw_setup(scene, choice);
    setup.fill = false;
    setup.max_disparity = 80;
    const auto engine = prepared("simd", 2, setup);
    const auto at = [&](Engine& by, int i) {
      by.focus({{i, i / 2, 20 + i % 8 * 16, 24 + i / 8 * 24}, 0, i % 3 == 0 ? 80 : 40});
      return run(by, scene.pair)->disparity.d_q4.clone();
    };
    for (int i = 19; i > 0; --i) at(*engine, i);
    for (const int i : {18, 1, 11, 6}) {
      const auto alone = prepared("simd", 1, setup);
      test::expect_same<std::uint16_t>(at(*alone, i), at(*engine, i), std::string(choice.matcher) + " " + std::to_string(i));
    }
  }
}

// Of the default matcher, that is: pyramid has memory for each size.
TEST(Focus, AllocatesNothing) {
  const SyntheticPair scene = room();
  for (const bool many_at_once : {false, true}) {
    duo::Setup setup = raw_setup(scene, kChoices[0]);
    setup.many_at_once = many_at_once;
    const auto engine = prepared("simd", 2, setup);
    for (int i = 0; i < 3; ++i) run(*engine, scene.pair);
    const long before = test::allocations;
    for (int i = 0; i < 6; ++i) {
      engine->focus({{i, i / 2, 20 + 20 * i, 90 - 12 * i}, 0, setup.max_disparity});
      run(*engine, scene.pair);
    }
    EXPECT_EQ(test::allocations - before, 0) << many_at_once;
  }
}

}  // namespace
}  // namespace duo
