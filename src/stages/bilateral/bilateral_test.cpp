#include "stages/bilateral/bilateral.h"

#include "tests/agree.h"

namespace duo {
namespace {

// By hand, range 3, the pixel 10 in the middle: neighbours 12 and 9 weigh 2 and 3, the five of 10 weigh 4 each, 50 nothing, the
// pixel itself 4: (2 * 2 - 3 * 1) / (2 + 3 + 24) rounds to 0. With two neighbours of 12 more: (6 * 2 - 3) / (6 + 3 + 16) =
// 0.36, and with all eight 12: 32 / (16 + 4) = 1.6, so 12.
TEST(Bilateral, HandWorked) {
  auto src = test::image<std::uint8_t>({{10, 12, 10}, {50, 10, 9}, {10, 10, 10}});
  EXPECT_EQ(bilateral_at(src, 3, 1, 1), 10);
  src = test::image<std::uint8_t>({{12, 12, 12}, {50, 10, 9}, {10, 10, 10}});
  EXPECT_EQ(bilateral_at(src, 3, 1, 1), 10);
  src = test::image<std::uint8_t>({{12, 12, 12}, {12, 10, 12}, {12, 12, 12}});
  EXPECT_EQ(bilateral_at(src, 3, 1, 1), 12);
  // Halves go up on both sides: with range 1, three of 11 weigh 1 each and the pixel 2 more than others' nothing.
  EXPECT_EQ(bilateral_at(test::image<std::uint8_t>({{11, 40, 40}, {40, 10, 11}, {40, 40, 40}}), 1, 1, 1), 11);  // 2 / 4
  EXPECT_EQ(bilateral_at(test::image<std::uint8_t>({{9, 40, 40}, {40, 10, 9}, {40, 40, 40}}), 1, 1, 1), 10);    // -2 / 4
}

TEST(Bilateral, RangeZeroChangesNothing) {
  std::mt19937 rng(1);
  Image<std::uint8_t> src({33, 9}), dst(src.size());
  test::fill(src.view(), test::Fill::kRandom, rng);
  ref::bilateral(src, 0, dst);
  test::expect_same<std::uint8_t>(src, dst, "bilateral 0");
}

TEST(Bilateral, NoiseGoesStepsStay) {
  std::mt19937 rng(2);
  std::normal_distribution<double> noise(0, 3);
  Image<std::uint8_t> src({64, 64}), dst(src.size());
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) src.at(y, x) = static_cast<std::uint8_t>(std::lround((x < 32 ? 80 : 120) + noise(rng)));
  ref::bilateral(src, 18, dst);
  double before = 0, after = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const int truth = x < 32 ? 80 : 120;
      before += (src.at(y, x) - truth) * (src.at(y, x) - truth);
      after += (dst.at(y, x) - truth) * (dst.at(y, x) - truth);
    }
  EXPECT_LT(after, before / 4);  // a ninth where all weigh the same; the step between columns 31 and 32 adds nothing
}

TEST(Bilateral, SimdAgrees) {
  std::mt19937 rng(5);
  Pool two(2);
  for (const Size size : test::awkward_sizes())
    for (const test::Fill how : test::kFills)
      for (const int range : {0, 1, 16, kMostBilateralRange}) {
        test::Tight<std::uint8_t> src(size), want(size);
        test::fill(src.view, how, rng);
        ref::bilateral(src.view, range, want.view);
        test::each_target([&](const std::string& target) {
          test::Tight<std::uint8_t> got(size);
          simd::bilateral(two, src.view, range, got.view);
          test::expect_same<std::uint8_t>(want.view, got.view, "bilateral " + target);
        });
        if (::testing::Test::HasFailure()) return;
      }
}

}  // namespace
}  // namespace duo
