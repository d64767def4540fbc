#include "stages/color_median/color_median.h"

#include <cmath>

#include "tests/agree.h"

namespace duo {
namespace {

constexpr int kEmpty = Disparity::kNone;

Image<std::uint16_t> colored(const ColorMedian& in) {
  Image<std::uint16_t> plain(in.d_q4.size()), threaded(in.d_q4.size());
  ref::color_median(in, plain);
  Pool two(2);
  simd::color_median(two, in, threaded);
  test::expect_same<std::uint16_t>(plain, threaded, "two threads");
  return plain;
}

TEST(ColorMedian, WeightsFollowTheirFormula) {
  for (int i = 0; i < 16; ++i)
    EXPECT_EQ(ColorMedian::kWeights[static_cast<std::size_t>(i)],
              std::max(1L, std::lround(255 * std::exp(-(4 * i + 1.5) / 10))));
}

// By hand, x = 4, radius 4: taps 0 2 4 6 8 with values 7 - 9 1 2. Steps 4 (green 4), a hole, 0, 64 (no weight), 12 (4 each):
// weights 147 of 7, 219 of 9, 66 of 2: 432. In the order of values 66, 213, 432: 216 is half, and 9 is the first to reach it.
TEST(ColorMedian, ByHand) {
  const auto d = test::image<std::uint16_t>({{7, 0, kEmpty, 0, 9, 0, 1, 0, 2}});
  Image<Rgb8> guide(d.size());
  for (int x = 0; x < 9; ++x) guide.at(0, x) = {100, 100, 100};
  guide.at(0, 0) = {100, 104, 100};
  guide.at(0, 6) = {100, 100, 164};
  guide.at(0, 8) = {96, 104, 104};
  EXPECT_EQ(colored({d, guide, {}, 4}).at(0, 4), 9);
  // One step less of green at 0, and its 219 make 504 with the 66 and 219: 285 is more than half, and 7 has it.
  guide.at(0, 0) = {100, 103, 100};
  EXPECT_EQ(colored({d, guide, {}, 4}).at(0, 4), 7);
  EXPECT_EQ(colored({d, guide, {}, 4}).at(0, 2), kEmpty);
}

TEST(ColorMedian, OnlyWhereChosen) {
  const auto d = test::image<std::uint16_t>({{5, 5, 50, 5, 5, 5, 50, 5, 5}});
  const auto chosen = test::image<std::uint8_t>({{0, 0, 1, 0, 0, 0, 0, 0, 0}});
  Image<Rgb8> guide(d.size());
  const auto got = colored({d, guide, chosen, 6});
  EXPECT_EQ(got.at(0, 2), 5);
  EXPECT_EQ(got.at(0, 6), 50);
}

// By hand, x = 4, radius 4: taps 0 2 4 6 8 with values 1 9 20 20 5, all of one colour. By distance 45 58 64 58 45, of the chosen
// ones a quarter: 45 of 1, 45 of 5, 58 of 9, 16 + 14 of 20 are 178, of which 1 and 5 have more than half. Unweighted it were 9.
TEST(ColorMedian, NearAndMeasuredTapsHaveMoreOfTheVote) {
  const auto d = test::image<std::uint16_t>({{1, 0, 9, 0, 20, 0, 20, 0, 5}});
  auto chosen = test::image<std::uint8_t>({{0, 0, 0, 0, 1, 0, 1, 0, 0}});
  const Image<Rgb8> guide(d.size());
  EXPECT_EQ(colored({d, guide, chosen, 4}).at(0, 4), 5);
  EXPECT_EQ(colored({d, guide, {}, 4}).at(0, 4), 9);
  chosen.at(0, 8) = 1;  // 45 of 1, 11 of 5, 58 of 9 and 30 of 20 are 144
  EXPECT_EQ(colored({d, guide, chosen, 4}).at(0, 4), 9);
}

}  // namespace
}  // namespace duo
