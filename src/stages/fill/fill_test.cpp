#include "stages/fill/fill.h"

#include "tests/agree.h"

namespace duo {
namespace {

using test::kNone;

Image<std::uint8_t> origin_of(View<const std::uint16_t> d) {
  Image<std::uint8_t> origin(d.size());
  ref::mark_measured(d, origin);
  return origin;
}

TEST(Fill, MarkMeasured) {
  const auto d = test::image<std::uint16_t>({{0, kNone, 80}});
  const auto want = test::image<std::uint8_t>({{1, 0, 1}});
  test::expect_same<std::uint8_t>(want, origin_of(d), "mark_measured ref");
  Image<std::uint8_t> got(d.size());
  Pool two(2);
  simd::mark_measured(two, d, got);
  test::expect_same<std::uint8_t>(want, got, "mark_measured simd");
}

TEST(Fill, TakesWhatTheMatcherSays) {
  Image<std::uint16_t> d = test::image<std::uint16_t>({{70, kNone, kNone, kNone}});
  auto origin = origin_of(d);
  take_filled(test::image<std::uint16_t>({{71, 72, kNone, 0}}), d, origin);
  test::expect_same<std::uint16_t>(test::image<std::uint16_t>({{70, 72, kNone, 0}}), d, "disparities");
  test::expect_same<std::uint8_t>(test::image<std::uint8_t>({{1, 2, 0, 2}}), origin, "origins");
}

// Too few disparities for a slope: the smaller one of both ends.
TEST(Fill, HandWorked) {
  const auto d = test::image<std::uint16_t>({{kNone, 80, kNone, kNone, 32, kNone}, {kNone, kNone, kNone, kNone, kNone, kNone}});
  auto origin = origin_of(d);
  Image<std::uint16_t> out(d.size());
  ref::fill(d, 64, origin, out);
  const int want[6] = {80, 80, 32, 32, 32, 32}, from[6] = {2, 1, 2, 2, 1, 2};
  for (int x = 0; x < 6; ++x) {
    EXPECT_EQ(out.at(0, x), want[x]) << x;
    EXPECT_EQ(origin.at(0, x), from[x]) << x;
    EXPECT_EQ(out.at(1, x), kNone) << "a row without measurements invents nothing";
    EXPECT_EQ(origin.at(1, x), 0);
  }
}

// By hand: a floor that falls by 1/16 px a column, hidden for 10 columns beside a box in front of it, and for the first 8
// columns of the picture. Every hole goes on as the floor does: 500 - x. The box, 300 nearer, does not reach into them. At two
// columns apart k = 0, 2 .. 22 the line through d = -k (left of a hole: + k) is met exactly.
TEST(Fill, SurfacesGoOnBehindEdges) {
  const Size size{80, 12};
  Image<std::uint16_t> d(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const bool box = x >= 50, hidden = x < 8 || (x >= 40 && x < 50);
      d.at(y, x) = hidden ? kNone : static_cast<std::uint16_t>(box ? 800 - 3 * y : 500 - x);
    }
  auto origin = origin_of(d);
  Image<std::uint16_t> out(size);
  ref::fill(d, 64, origin, out);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < 50; ++x) {
      EXPECT_EQ(out.at(y, x), 500 - x) << y << " " << x;
      EXPECT_EQ(origin.at(y, x), x < 8 || x >= 40 ? 2 : 1) << y << " " << x;
    }
  // Seven columns alone take the value at their end.
  for (int y = 0; y < size.height; ++y)
    for (int x = 40; x < 43; ++x) d.at(y, x) = static_cast<std::uint16_t>(500 - x);
  origin = origin_of(d);
  ref::fill(d, 64, origin, out);
  for (int x = 43; x < 50; ++x) EXPECT_EQ(out.at(5, x), 500 - 42) << x;
  // Values stay in the range that is searched.
  origin = origin_of(d);
  ref::fill(d, 30, origin, out);
  EXPECT_EQ(out.at(5, 0), 16 * 29);
}

TEST(Fill, SimdAgrees) {
  std::mt19937 rng(8);
  Pool one(1), two(2);
  for (const Size size : test::awkward_sizes())
    for (const unsigned hole_share : {0u, 3u, 9u, 10u}) {
      Image<std::uint16_t> d(size);
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
          d.at(y, x) = rng() % 10 < hole_share ? Disparity::kNone : static_cast<std::uint16_t>(900 + x + rng() % 9);
      Image<std::uint16_t> want(size);
      auto want_origin = origin_of(d);
      ref::fill(d, 64, want_origin, want);
      for (Pool* pool : {&one, &two}) {
        Image<std::uint16_t> got(size);
        auto got_origin = origin_of(d);
        simd::fill(*pool, d, 64, got_origin, got);
        test::expect_same<std::uint16_t>(want, got, "fill simd");
        test::expect_same<std::uint8_t>(want_origin, got_origin, "fill origin simd");
      }
    }
}

}  // namespace
}  // namespace duo
