#include "stages/speckle/speckle.h"

#include "tests/agree.h"
#include "tests/time.h"

namespace duo {
namespace {

using test::kNone;

// By hand, step 16: 100 100 / 100 . joins three pixels; 400 touches them only with a larger step; 110 is 4-connected to none.
TEST(Speckle, HandWorked) {
  const auto src = test::image<std::uint16_t>({{100, 100, 400, kNone}, {100, kNone, kNone, 110}, {kNone, 105, 105, kNone}});
  auto d = src.clone();
  ref::remove_speckle(d, 16, 3);
  const int want[3][4] = {{100, 100, kNone, kNone}, {100, kNone, kNone, kNone}, {kNone, kNone, kNone, kNone}};
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x) EXPECT_EQ(d.at(y, x), want[y][x]) << y << " " << x;
  d = src.clone();
  ref::remove_speckle(d, 300, 4);
  EXPECT_EQ(d.at(0, 2), 400);
  EXPECT_EQ(d.at(2, 1), kNone);
}

TEST(Speckle, SimdAgrees) {
  std::mt19937 rng(9);
  Pool one(1), two(2), three(3);
  auto sizes = test::awkward_sizes();
  sizes.push_back({70, 150});  // several bands
  for (const Size size : sizes)
    for (const unsigned levels : {2u, 4u, 40u})
      for (const int smallest : {1, 2, 7, 50}) {
        Image<std::uint16_t> d(size);
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x)
            d.at(y, x) = rng() % 6 == 0 ? Disparity::kNone : 20 * (rng() % levels) + rng() % 3;
        auto want = d.clone();
        ref::remove_speckle(want, 16, smallest);
        for (Pool* pool : {&one, &two, &three}) {
          auto got = d.clone();
          simd::SpeckleScratch scratch(size);
          simd::remove_speckle(*pool, got, 16, smallest, scratch);
          test::expect_same<std::uint16_t>(want, got, "speckle simd threads " + std::to_string(pool->threads()));
        }
      }
}

// Slanted surfaces with noise, holes and steps, as a matcher gives them; the picture stays as it is because `smallest` is 0.
TEST(Speckle, Time) {
  const Size size{640, 480};
  std::mt19937 rng(10);
  Image<std::uint16_t> d(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      d.at(y, x) =
          rng() % 12 == 0 ? Disparity::kNone : (x / 90 + y / 70) % 3 * 200 + x / 4 + rng() % 9 + (rng() % 40 == 0 ? 300 : 0);
  simd::SpeckleScratch scratch(size);
  Pool one(1);
  test::print_time("speckle", size, [&] { simd::remove_speckle(one, d, 16, 0, scratch); });
}

}  // namespace
}  // namespace duo
