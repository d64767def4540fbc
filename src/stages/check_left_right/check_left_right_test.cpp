#include "stages/check_left_right/check_left_right.h"

#include "tests/agree.h"

namespace duo {
namespace {

constexpr int kNone = Disparity::kNone;

// By hand, tolerance 1: x = 3 with d = 2 looks at right x = 1, which says 3: kept. x = 4 with d = 1 looks at x = 3, which says
// 4: gone; with reach 1 it also sees x = 2, which says 2: kept. x = 5 has no winner.
TEST(CheckLeftRight, HandWorked) {
  const auto left = test::image<std::int16_t>({{0, 0, 0, 2, 1, -1}});
  const auto right = test::image<std::int16_t>({{-1, 3, 2, 4, 4, 4}});
  const auto fine = test::image<std::uint16_t>({{0, 0, 0, 35, 14, kNone}});
  Image<std::uint16_t> dst(left.size());
  ref::check_left_right({left, right}, fine, dst);
  const int want[6] = {kNone, kNone, kNone, 35, kNone, kNone};
  for (int x = 0; x < 6; ++x) EXPECT_EQ(dst.at(0, x), want[x]) << x;

  CheckLeftRight wider{left, right};
  wider.reach = 1;
  ref::check_left_right(wider, fine, dst);
  EXPECT_EQ(dst.at(0, 4), 14);

  Image<std::int16_t> winners(left.size());
  ref::check_winners({left, right}, winners);
  EXPECT_EQ(winners.at(0, 3), 2);
  EXPECT_EQ(winners.at(0, 4), -1);
}

// x = 0 with d = 1 would look beyond the picture, where reach 1 must not find x = 0.
TEST(CheckLeftRight, BeyondThePictureIsNotKept) {
  const auto left = test::image<std::int16_t>({{1, 1}}), right = test::image<std::int16_t>({{1, 1}});
  const auto fine = test::image<std::uint16_t>({{16, 16}});
  Image<std::uint16_t> dst(left.size());
  CheckLeftRight in{left, right};
  in.reach = 1;
  ref::check_left_right(in, fine, dst);
  EXPECT_EQ(dst.at(0, 0), kNone);
  EXPECT_EQ(dst.at(0, 1), 16);
}

TEST(CheckLeftRight, OutsideIsNotKept) {
  const auto both = test::image<std::int16_t>({{0, 0, 0}});
  const auto fine = test::image<std::uint16_t>({{0, 0, 0}});
  const auto left_inside = test::image<std::uint8_t>({{255, 0, 255}}),
             right_inside = test::image<std::uint8_t>({{255, 255, 0}});
  Image<std::uint16_t> dst(both.size());
  ref::check_left_right({both, both, left_inside, right_inside}, fine, dst);
  EXPECT_EQ(dst.at(0, 0), 0);
  EXPECT_EQ(dst.at(0, 1), kNone);
  EXPECT_EQ(dst.at(0, 2), kNone);
}

TEST(CheckLeftRight, SimdAgrees) {
  std::mt19937 rng(14);
  Pool two(2);
  for (const Size size : test::awkward_sizes())
    for (const int reach : {0, 1}) {
      test::Tight<std::int16_t> left(size), right(size), want_winner(size), got_winner(size);
      test::Tight<std::uint16_t> fine(size), want(size), got(size);
      test::Tight<std::uint8_t> inside(size);
      test::fill(fine.view, test::Fill::kRandom, rng);
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
          left.view.at(y, x) = static_cast<std::int16_t>(static_cast<int>(rng() % 8) - 1);
          right.view.at(y, x) = static_cast<std::int16_t>(static_cast<int>(rng() % 7) - 1);
          inside.view.at(y, x) = rng() % 4 ? 255 : 0;
        }
      CheckLeftRight in{left.view, right.view, inside.view, inside.view};
      in.reach = reach;
      ref::check_left_right(in, fine.view, want.view);
      simd::check_left_right(two, in, fine.view, got.view);
      test::expect_same<std::uint16_t>(want.view, got.view, "check_left_right simd");
      ref::check_winners(in, want_winner.view);
      simd::check_winners(two, in, got_winner.view);
      test::expect_same<std::int16_t>(want_winner.view, got_winner.view, "check_winners simd");
    }
}

}  // namespace
}  // namespace duo
