#include "stages/check_left_right/check_left_right.h"

#include "tests/agree.h"

namespace duo {
namespace {

using test::kNone;

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

/// Surfaces some pixels wide: mostly few winners side by side, now and then none, far beyond the row, or each another.
void fill_winners(View<std::int16_t> out, int most, std::mt19937& rng) {
  const auto up_to = [&](int n) { return static_cast<int>(rng() % static_cast<unsigned>(n)); };
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0, left = 0, winner = 0; x < out.width(); ++x) {
      if (left-- == 0) left = up_to(12), winner = up_to(most + 1) - 1;
      out.at(y, x) = static_cast<std::int16_t>(rng() % 9 == 0 ? up_to(most + 1) - 1 : winner);
    }
}

TEST(CheckLeftRight, SimdAgrees) {
  test::each_target([](const std::string& target) {
    std::mt19937 rng(14);
    Pool two(2);
    int kept = 0;
    auto sizes = test::awkward_sizes();
    sizes.push_back({199, 6});
    for (const Size size : sizes)
      for (const int reach : {0, 1, 4})
        for (const int most : {8, 40, 300}) {
          test::Tight<std::int16_t> left(size), right(size), want_winner(size), got_winner(size);
          test::Tight<std::uint16_t> fine(size), want(size), got(size);
          test::Tight<std::uint8_t> inside(size), other_inside(size);
          test::fill(fine.view, test::Fill::kRandom, rng);
          fill_winners(left.view, most, rng);
          fill_winners(right.view, most, rng);
          for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x) {
              // So that some agree.
              if (const int there = x - left.view.at(y, x); rng() % 2 == 0 && there >= 0 && there < size.width)
                right.view.at(y, there) = left.view.at(y, x);
              inside.view.at(y, x) = rng() % 4 ? 255 : 0;
              other_inside.view.at(y, x) = rng() % 4 ? 255 : 0;
            }
          CheckLeftRight in{left.view, right.view, inside.view, other_inside.view};
          if (reach == 4) in.left_inside = in.right_inside = {};
          in.reach = reach;
          in.tolerance = reach;
          ref::check_left_right(in, fine.view, want.view);
          simd::check_left_right(two, in, fine.view, got.view);
          test::expect_same<std::uint16_t>(want.view, got.view, "check_left_right " + target);
          ref::check_winners(in, want_winner.view);
          simd::check_winners(two, in, got_winner.view);
          test::expect_same<std::int16_t>(want_winner.view, got_winner.view, "check_winners " + target);
          for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x) kept += want_winner.view.at(y, x) >= 0;
        }
    EXPECT_GT(kept, 2000) << "the comparison is not about nothing";
  });
}

}  // namespace
}  // namespace duo
