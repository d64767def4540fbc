#include "stages/mark_invalid/mark_invalid.h"

#include "tests/agree.h"

namespace duo {
namespace {

using test::kNone;

// By hand, N = 4: -1 negative; 2 at x = 1 leaves the right picture; 4 is out of range; 3 at x = 4 lands on x = 1.
TEST(MarkInvalid, HandWorked) {
  const auto winner = test::image<std::int16_t>({{-1, 2, 2, 4, 3, 0}});
  Image<std::uint16_t> dst(winner.size());
  ref::mark_invalid(winner, {}, {}, 4, dst);
  const int want[6] = {kNone, kNone, 32, kNone, 48, 0};
  for (int x = 0; x < 6; ++x) EXPECT_EQ(dst.at(0, x), want[x]) << x;

  const auto left = test::image<std::uint8_t>({{255, 255, 255, 255, 255, 0}});
  const auto right = test::image<std::uint8_t>({{0, 255, 255, 255, 255, 255}});
  ref::mark_invalid(winner, left, right, 4, dst);
  EXPECT_EQ(dst.at(0, 2), kNone) << "matches right pixel 0, which is outside";
  EXPECT_EQ(dst.at(0, 4), 48);
  EXPECT_EQ(dst.at(0, 5), kNone) << "left pixel outside";
}

TEST(MarkInvalid, SimdAgrees) {
  std::mt19937 rng(10);
  Pool two(2);
  for (const Size size : test::awkward_sizes())
    for (const bool masked : {false, true}) {
      test::Tight<std::int16_t> winner(size);
      test::Tight<std::uint8_t> left(size), right(size);
      test::Tight<std::uint16_t> want(size), got(size);
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
          winner.view.at(y, x) = static_cast<std::int16_t>(static_cast<int>(rng() % 50) - 10);
          left.view.at(y, x) = rng() % 4 ? 255 : 0;
          right.view.at(y, x) = rng() % 4 ? 255 : 0;
        }
      const View<const std::uint8_t> none, l = masked ? left.view : none, r = masked ? right.view : none;
      ref::mark_invalid(winner.view, l, r, 32, want.view);
      simd::mark_invalid(two, winner.view, l, r, 32, got.view);
      test::expect_same<std::uint16_t>(want.view, got.view, "mark_invalid simd");
    }
}

}  // namespace
}  // namespace duo
