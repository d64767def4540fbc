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

TEST(Fill, HandWorked) {
  auto d = test::image<std::uint16_t>({{kNone, 80, kNone, kNone, 32, kNone}, {kNone, kNone, kNone, kNone, kNone, kNone}});
  auto origin = origin_of(d);
  ref::fill(d, origin);
  const int want[6] = {80, 80, 32, 32, 32, 32}, from[6] = {2, 1, 2, 2, 1, 2};
  for (int x = 0; x < 6; ++x) {
    EXPECT_EQ(d.at(0, x), want[x]) << x;
    EXPECT_EQ(origin.at(0, x), from[x]) << x;
    EXPECT_EQ(d.at(1, x), kNone) << "a row without measurements invents nothing";
    EXPECT_EQ(origin.at(1, x), 0);
  }
}

TEST(Fill, SimdAgrees) {
  std::mt19937 rng(8);
  Pool one(1), two(2);
  for (const Size size : test::awkward_sizes())
    for (const unsigned hole_share : {0u, 3u, 9u, 10u}) {
      Image<std::uint16_t> d(size);
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) d.at(y, x) = rng() % 10 < hole_share ? Disparity::kNone : rng() % 2000;
      auto want = d.clone();
      auto want_origin = origin_of(d);
      ref::fill(want, want_origin);
      for (Pool* pool : {&one, &two}) {
        auto got = d.clone();
        auto got_origin = origin_of(d);
        simd::fill(*pool, got, got_origin);
        test::expect_same<std::uint16_t>(want, got, "fill simd");
        test::expect_same<std::uint8_t>(want_origin, got_origin, "fill origin simd");
      }
    }
}

}  // namespace
}  // namespace duo
