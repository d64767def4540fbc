#include "stages/gaussian/gaussian.h"

#include "tests/agree.h"

namespace duo {
namespace {

// By hand: a single 255 spreads as 255 * w_y * w_x / 256: centre 36 -> 35.9 -> 36, beside it 24 -> 23.9 -> 24, corner 1 -> 1.
TEST(Gaussian, HandWorkedImpulse) {
  auto src = test::constant<std::uint8_t>({7, 7}, 0);
  src.at(3, 3) = 255;
  Image<std::uint8_t> dst(src.size());
  ref::gaussian5x5(src, dst);
  EXPECT_EQ(dst.at(3, 3), 36);
  EXPECT_EQ(dst.at(3, 2), 24);
  EXPECT_EQ(dst.at(2, 2), 16);
  EXPECT_EQ(dst.at(1, 1), 1);
  EXPECT_EQ(dst.at(0, 3), 0);
}

// By hand: at the left edge of a step 0 | 160 the columns weigh 1+4+6 | 4+1: x=1 (0,0,0,160,160) -> 160 * 5 / 16 = 50.
TEST(Gaussian, HandWorkedStep) {
  const auto src = test::image<std::uint8_t>({{0, 0, 160, 160}});
  Image<std::uint8_t> dst(src.size());
  ref::gaussian5x5(src, dst);
  EXPECT_EQ(dst.at(0, 1), 50);
  EXPECT_EQ(dst.at(0, 0), 10);
  EXPECT_EQ(dst.at(0, 3), 150);
}

TEST(Gaussian, SimdAgrees) {
  test::agree<std::uint8_t, std::uint8_t>(
      "gaussian", [](auto src, auto dst) { ref::gaussian5x5(src, dst); },
      [](Pool& pool, auto src, auto dst) { simd::gaussian5x5(pool, src, dst); });
}

TEST(Gaussian, SimdAgreesOverChunks) {
  std::mt19937 rng(3);
  Pool two(2);
  for (const int width : {511, 512, 513, 516, 1030}) {
    test::Tight<std::uint8_t> src({width, 6}), want({width, 6});
    test::fill(src.view, test::Fill::kRandom, rng);
    ref::gaussian5x5(src.view, want.view);
    test::each_target([&](const std::string& target) {
      test::Tight<std::uint8_t> got({width, 6});
      simd::gaussian5x5(two, src.view, got.view);
      test::expect_same<std::uint8_t>(want.view, got.view, "gaussian simd " + target);
    });
  }
}

}  // namespace
}  // namespace duo
