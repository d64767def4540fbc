#include "stages/diffusion/diffusion.h"

#include <cmath>

#include "tests/agree.h"

namespace duo {
namespace {

Image<std::uint8_t> diffused(View<const std::uint8_t> src) {
  Image<std::uint8_t> dst(src.size());
  ref::diffuse(src, dst);
  return dst;
}

TEST(Diffusion, ConductanceFollowsItsFormula) {
  for (int i = 0; i < 16; ++i)
    EXPECT_EQ(Diffusion::kConductance[static_cast<std::size_t>(i)],
              std::lround(255 * std::exp(-std::pow((2 * i + 1) / double(Diffusion::kEdge), 2))))
        << i;
}

// By hand, in 1/64 of a gray level: 100 and 108 are 6400 and 6912, 512 apart, i = 4. What flows is 512 * 113 / 256 = 226; a
// quarter of it, 56.5, is 57 for the one and -56 for the other. Then 6457 and 6856, 399 apart: 399 * 156 / 256 = 243, 61; 6518
// and 6795, 277 apart: 215, 54; 6572 and 6741, 169: 154, 39 and -38; 6611 and 6703, 92: 91, 23; 6634 and 6680, which are 103.7
// and 104.4.
TEST(Diffusion, HandWorked) {
  const auto src = test::image<std::uint8_t>({{100, 108}});
  test::expect_same<std::uint8_t>(test::image<std::uint8_t>({{104, 104}}), diffused(src), "two pixels");
  // A step of 32 gray levels is an edge.
  const auto edge = test::image<std::uint8_t>({{100, 132}, {100, 132}});
  test::expect_same<std::uint8_t>(edge, diffused(edge), "edge");
}

TEST(Diffusion, SimdAgrees) {
  std::mt19937 rng(51);
  static Pool one(1), two(2);
  for (const Size size : test::awkward_sizes())
    for (const test::Fill how : test::kFills) {
      test::Tight<std::uint8_t> src(size);
      test::fill(src.view, how, rng);
      if (how == test::Fill::kRandom)
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x) src.view.at(y, x) = static_cast<std::uint8_t>(100 + src.view.at(y, x) % 40);
      const auto want = diffused(src.view);
      test::each_target([&](const std::string& target) {
        simd::DiffusionScratch scratch(size);
        for (Pool* pool : {&one, &two}) {
          test::Tight<std::uint8_t> got(size);
          simd::diffuse(*pool, src.view, scratch, got.view);
          test::expect_same<std::uint8_t>(want, got.view, "diffusion " + target);
        }
      });
      if (HasFailure()) return;
    }
}

}  // namespace
}  // namespace duo
