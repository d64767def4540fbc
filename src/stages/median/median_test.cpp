#include "stages/median/median.h"

#include "tests/agree.h"

namespace duo {
namespace {

// By hand: the corner sees {10,10,20, 10,10,20, 40,40,50} (edges repeated) -> 20; the centre of 10..90 sees all nine -> 50.
TEST(Median, HandWorked) {
  const auto src = test::image<std::uint8_t>({{10, 20, 30}, {40, 50, 60}, {70, 80, 90}});
  Image<std::uint8_t> dst(src.size());
  ref::median3x3(src, dst);
  EXPECT_EQ(dst.at(0, 0), 20);
  EXPECT_EQ(dst.at(1, 1), 50);
  EXPECT_EQ(dst.at(2, 2), 80);
}

TEST(Median, RemovesOneSaltPixel) {
  auto src = test::constant<std::uint8_t>({5, 5}, 7);
  src.at(2, 2) = 255;
  Image<std::uint8_t> dst(src.size());
  ref::median3x3(src, dst);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x) EXPECT_EQ(dst.at(y, x), 7);
}

TEST(Median, SimdAgreesU8) {
  test::agree<std::uint8_t, std::uint8_t>(
      "median u8", [](auto src, auto dst) { ref::median3x3(src, dst); },
      [](Pool& pool, auto src, auto dst) { simd::median3x3(pool, src, dst); });
}

TEST(Median, SimdAgreesU16) {
  test::agree<std::uint16_t, std::uint16_t>(
      "median u16", [](auto src, auto dst) { ref::median3x3(src, dst); },
      [](Pool& pool, auto src, auto dst) { simd::median3x3(pool, src, dst); });
}

}  // namespace
}  // namespace duo
