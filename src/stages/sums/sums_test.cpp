#include "stages/sums/sums.h"

#include <cmath>

#include "stages/sums/hue_circle.h"
#include "tests/areas.h"
#include "tests/time.h"

namespace duo {
namespace {

using test::kNone;

TEST(HueCircle, IsSineAndCosine) {
  for (int hue = 0; hue < 256; ++hue) {
    EXPECT_EQ(hue_sin_q14(hue), std::lround(16384 * std::sin(hue * M_PI / 128))) << hue;
    EXPECT_EQ(hue_cos_q14(hue), std::lround(16384 * std::cos(hue * M_PI / 128))) << hue;
  }
}

// By hand: marked with bit 1 are (0,1), (0,3), (2,1), (2,2); (1,0) has another bit.
TEST(Sums, HandWorked) {
  const auto marks = test::image<std::uint8_t>({{0, 2, 0, 3}, {1, 0, 0, 0}, {0, 2, 2, 0}});
  const auto hue = test::image<std::uint8_t>({{9, 0, 9, 64}, {9, 9, 9, 9}, {9, 64, 128, 9}});
  const auto d = test::image<std::uint16_t>({{9, 100, 9, kNone}, {9, 9, 9, 9}, {9, 300, 20, 9}});
  Sums in{marks.size(), {Window::all(marks.size())}, hue, d};
  in.area.marks = marks;
  in.area.bits = 2;
  AreaSums want;
  want.count = 4;
  want.x = 1 + 3 + 1 + 2;
  want.y = 4;
  want.xx = 1 + 9 + 1 + 4;
  want.xy = 2 + 4;
  want.yy = 8;
  want.known = 3;
  want.d_q4 = 420;
  want.hue_cos_q14 = 0;  // 1 + 0 + 0 - 1
  want.hue_sin_q14 = 2 * 16384;
  want.first = {0, 1};
  want.last = {2, 3};
  EXPECT_EQ(ref::sums(in), want);
  EXPECT_EQ(mean_hue(want), std::uint8_t{64});

  in.area.window = {1, 1, 2, 9};
  const AreaSums part = ref::sums(in);
  EXPECT_EQ(part.count, 2);
  EXPECT_EQ(part.first, (Pixel{2, 1}));
  in.area.window = {0, 1, 4, 1};
  EXPECT_EQ(ref::sums(in), AreaSums{}) << "nothing marked there";
}

// By hand: half of red lies just below the full circle and half just above; the plain mean would be 127.
TEST(Sums, MeanHueAcrossRed) {
  const auto hue = test::image<std::uint8_t>({{250, 4, 252, 2}});
  EXPECT_EQ(mean_hue(ref::sums({hue.size(), {Window::all(hue.size())}, hue})), std::uint8_t{255});
  const auto opposite = test::image<std::uint8_t>({{10, 138}});
  EXPECT_EQ(mean_hue(ref::sums({opposite.size(), {Window::all(opposite.size())}, opposite})), std::nullopt);
}

// By hand: a disc of radius 2 has 1 + 3 + 5 + 3 + 1 pixels.
TEST(Sums, Disc) {
  const AreaSums got = ref::sums({{9, 9}, {Window::all({9, 9}), {4, 4, 2}}});
  EXPECT_EQ(got.count, 13);
  EXPECT_EQ(got.x, 4 * 13);
  EXPECT_EQ(got.first, (Pixel{2, 2}));
  EXPECT_EQ(got.last, (Pixel{6, 6}));
}

TEST(Sums, SimdAgrees) {
  std::mt19937 rng(12);
  Pool one(1), two(2), three(3);
  for (const Size size : test::awkward_sizes())
    for (int round = 0; round < 24; ++round) {
      test::Tight<std::uint8_t> marks(size), hue(size);
      test::Tight<std::uint16_t> d(size);
      test::fill_marks(marks.view, rng);
      test::fill(hue.view, test::Fill::kRandom, rng);
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) d.view.at(y, x) = rng() % 4 == 0 ? kNone : rng();
      Sums in{size, test::random_area(rng, size, marks.view)};
      if (round % 3 != 0) in.hue = hue.view;
      if (round % 4 != 0) in.d_q4 = d.view;
      for (Pool* pool : {&one, &two, &three})
        EXPECT_EQ(simd::sums(*pool, in), ref::sums(in)) << size.width << "x" << size.height << " round " << round;
      if (HasFailure()) return;
    }
}

TEST(Sums, Time) {
  const Size size{640, 480};
  std::mt19937 rng(13);
  auto marks = test::constant<std::uint8_t>(size, 1);
  Image<std::uint8_t> hue(size);
  test::fill(hue.view(), test::Fill::kRandom, rng);
  const auto d = test::constant<std::uint16_t>(size, 300);
  Pool one(1);
  Sums in{size, {Window::all(size), {}, marks, 1}, hue, d};
  test::print_time("sums, all marked", size, [&] { simd::sums(one, in); });
  in.area.bits = 2;
  test::print_time("sums, none marked", size, [&] { simd::sums(one, in); });
  in.area.bits = 1;
  in.area.window = {300, 200, 120, 120};
  test::print_time("sums, 120x120 marked", size, [&] { simd::sums(one, in); });
}

}  // namespace
}  // namespace duo
