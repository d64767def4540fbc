#include "stages/erode/erode.h"

#include "tests/agree.h"
#include "tests/time.h"

namespace duo {
namespace {

// By hand. Bit 0 is a plus sign: of it only the centre has its four neighbours, and nothing has eight. Bit 1 is the lower three
// rows: their upper row goes, the border takes nothing.
TEST(Erode, HandWorked) {
  const auto src = test::image<std::uint8_t>({{0, 0, 1, 0, 0}, {2, 3, 3, 3, 2}, {2, 2, 3, 2, 2}, {2, 2, 2, 2, 2}});
  Image<std::uint8_t> dst(src.size());
  ref::erode(src, Neighbours::kFour, dst);
  test::expect_same<std::uint8_t>(
      test::image<std::uint8_t>({{0, 0, 0, 0, 0}, {0, 0, 1, 0, 0}, {2, 2, 2, 2, 2}, {2, 2, 2, 2, 2}}), dst, "four");
  ref::erode(src, Neighbours::kEight, dst);
  test::expect_same<std::uint8_t>(
      test::image<std::uint8_t>({{0, 0, 0, 0, 0}, {0, 0, 0, 0, 0}, {2, 2, 2, 2, 2}, {2, 2, 2, 2, 2}}), dst, "eight");
}

// By hand: a hole of one pixel in bit 7 takes its diagonal neighbours only where all eight count.
TEST(Erode, DiagonalNeighbours) {
  auto src = test::constant<std::uint8_t>({5, 5}, 0x80);
  src.at(2, 2) = 0;
  Image<std::uint8_t> four(src.size()), eight(src.size());
  ref::erode(src, Neighbours::kFour, four);
  ref::erode(src, Neighbours::kEight, eight);
  EXPECT_EQ(four.at(1, 1), 0x80);
  EXPECT_EQ(eight.at(1, 1), 0);
  EXPECT_EQ(four.at(1, 2), 0);
  EXPECT_EQ(eight.at(1, 0), 0x80);
}

TEST(Erode, SimdAgrees) {
  for (const Neighbours neighbours : {Neighbours::kFour, Neighbours::kEight}) {
    test::agree<std::uint8_t, std::uint8_t>(
        "erode", [&](auto src, auto dst) { ref::erode(src, neighbours, dst); },
        [&](Pool& pool, auto src, auto dst) { simd::erode(pool, src, neighbours, dst); });
  }
}

// Random bytes erode to nearly nothing; mostly full ones keep something to disagree about.
TEST(Erode, SimdAgreesOnDenseMarks) {
  std::mt19937 rng(5);
  Pool three(3);
  for (const Size size : test::awkward_sizes())
    for (const Neighbours neighbours : {Neighbours::kFour, Neighbours::kEight}) {
      test::Tight<std::uint8_t> src(size), want(size), got(size);
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
          src.view.at(y, x) = static_cast<std::uint8_t>(0xFF & ~(rng() % 4 ? 0u : 1u << rng() % 8));
      ref::erode(src.view, neighbours, want.view);
      test::each_target([&](const std::string& target) {
        simd::erode(three, src.view, neighbours, got.view);
        test::expect_same<std::uint8_t>(want.view, got.view, "erode simd " + target);
      });
    }
}

TEST(Erode, Time) {
  const auto src = test::constant<std::uint8_t>({640, 480}, 0x15);
  Image<std::uint8_t> dst(src.size());
  Pool one(1);
  test::print_time("erode, 8 neighbours", src.size(), [&] { simd::erode(one, src, Neighbours::kEight, dst); });
}

}  // namespace
}  // namespace duo
