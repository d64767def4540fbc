#include "stages/halve/halve.h"

#include "tests/agree.h"

namespace duo {
namespace {

template <class Ref, class Simd>
void agree_half(const std::string& stage, Ref ref, Simd simd) {
  std::mt19937 rng(4);
  Pool one(1), two(2);
  for (const Size size : test::awkward_sizes())
    for (const test::Fill how : test::kFills) {
      test::Tight<std::uint8_t> src(size), want(half_of(size));
      test::fill(src.view, how, rng);
      ref(View<const std::uint8_t>(src.view), want.view);
      test::each_target([&](const std::string& target) {
        for (Pool* pool : {&one, &two}) {
          test::Tight<std::uint8_t> got(half_of(size));
          simd(*pool, View<const std::uint8_t>(src.view), got.view);
          test::expect_same<std::uint8_t>(want.view, got.view, stage + " simd " + target);
        }
      });
    }
}

// By hand: (1+2+3+5+2)/4 = 3.25 -> 3; the odd column (4, 9) counts twice: (4+4+9+9+2)/4 = 7.
TEST(Halve, HandWorked) {
  const auto src = test::image<std::uint8_t>({{1, 2, 4}, {3, 5, 9}});
  Image<std::uint8_t> dst(half_of(src.size()));
  ref::halve(src, dst);
  EXPECT_EQ(dst.width(), 2);
  EXPECT_EQ(dst.at(0, 0), 3);
  EXPECT_EQ(dst.at(0, 1), 7);
}

TEST(Halve, InsideNeedsAllFour) {
  const auto src = test::image<std::uint8_t>({{255, 255, 255, 255}, {255, 0, 255, 255}});
  Image<std::uint8_t> dst(half_of(src.size()));
  ref::halve_inside(src, dst);
  EXPECT_EQ(dst.at(0, 0), 0);
  EXPECT_EQ(dst.at(0, 1), 255);
}

TEST(Halve, SimdAgrees) {
  agree_half("halve", [](auto src, auto dst) { ref::halve(src, dst); },
             [](Pool& pool, auto src, auto dst) { simd::halve(pool, src, dst); });
}

TEST(Halve, InsideSimdAgrees) {
  agree_half("halve_inside", [](auto src, auto dst) { ref::halve_inside(src, dst); },
             [](Pool& pool, auto src, auto dst) { simd::halve_inside(pool, src, dst); });
}

}  // namespace
}  // namespace duo
