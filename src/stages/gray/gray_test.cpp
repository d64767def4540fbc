#include "stages/gray/gray.h"

#include "tests/agree.h"

namespace duo {
namespace {

// By hand: (77 * 100 + 150 * 50 + 29 * 200 + 128) / 256 = 21128 / 256 = 82.5 -> 82.
TEST(Gray, HandWorked) {
  Image<Rgb8> src({3, 1});
  src.at(0, 0) = {100, 50, 200};
  src.at(0, 1) = {255, 255, 255};
  src.at(0, 2) = {255, 0, 0};
  Image<std::uint8_t> dst(src.size());
  ref::gray(src, dst);
  EXPECT_EQ(dst.at(0, 0), 82);
  EXPECT_EQ(dst.at(0, 1), 255);
  EXPECT_EQ(dst.at(0, 2), 77);
}

TEST(Gray, SimdAgrees) {
  std::mt19937 rng(2);
  Pool one(1), two(2);
  for (const Size size : test::awkward_sizes()) {
    test::Tight<Rgb8> src(size);
    test::Tight<std::uint8_t> want(size);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const auto v = rng();
        src.view.at(y, x) = {static_cast<std::uint8_t>(v), static_cast<std::uint8_t>(v >> 8), static_cast<std::uint8_t>(v >> 16)};
      }
    ref::gray(src.view, want.view);
    test::each_target([&](const std::string& target) {
      for (Pool* pool : {&one, &two}) {
        test::Tight<std::uint8_t> got(size);
        simd::gray(*pool, src.view, got.view);
        test::expect_same<std::uint8_t>(want.view, got.view, "gray simd " + target);
      }
    });
  }
}

}  // namespace
}  // namespace duo
