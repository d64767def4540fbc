#include "stages/semi_global/semi_global.h"

#include "tests/agree.h"
#include "tests/semi_global_views.h"

namespace duo {
namespace {

using test::Views;

struct Match {
  Image<std::int16_t> left, right;
  Image<std::uint16_t> fine;
  Image<std::uint8_t> margin;
  explicit Match(Size size) : left(size), right(size), fine(size), margin(size) {}
  SemiGlobalMatch out() { return {left, right, fine, margin}; }
};

// One row, two disparities, and only gray counts: the census is cut at 0, gradients are flat, intervals are the values alone.
// Left is 50 everywhere, right 50 10 50: x = 0 fits both (d = 1 meets the continued edge), x = 1 fits d = 1 alone, x = 2 fits d
// = 0 alone.
TEST(SemiGlobal, HandWorked) {
  const auto left = test::image<std::uint8_t>({{50, 50, 50}}), right = test::image<std::uint8_t>({{50, 10, 50}});
  Views views(left, right, {}, 2);
  views.keep_gray_alone();
  SemiGlobalParams params;
  params.census_truncation = 0;
  params.truncation = 8;
  params.p1 = 3;
  params.p2 = params.p2_least = 5;
  Match got(left.size());
  ref::semi_global(views.in(2, params), got.out());
  // C: x = 0 (0 0), x = 1 (8 0), x = 2 (0 8).
  // From the left: (0 0), (8 0), then (0 + min(8, 0 + 3), 8 + 0) = (3 8). From the right: (0 8), x = 1: (8 + 0, 0 + min(8, 3))
  // = (8 3), x = 0: least 3, (min(8, 3 + 3) - 3, 0) = (3 0). Down: C. S: x = 0 (3 0), x = 1 (24 3), x = 2 (3 24).
  EXPECT_EQ(got.left.at(0, 0), 1);
  EXPECT_EQ(got.left.at(0, 1), 1);
  EXPECT_EQ(got.left.at(0, 2), 0);
  // Right winner of x: S(x, 0) against S(x + 1, 1): x = 0: 3 against 3: the smaller d; x = 1: 24 against 24; x = 2: alone.
  for (int x = 0; x < 3; ++x) EXPECT_EQ(got.right.at(0, x), 0) << x;
}

TEST(SemiGlobal, SubPixelLeansToTheCheaperSide) {
  // A textured slope moved by 5 px everywhere; a wall at one disparity must come out whole, with small fractions.
  std::mt19937 rng(3);
  Image<std::uint8_t> texture({90, 20}), left({80, 20}), right({80, 20});
  test::fill(texture.view(), test::Fill::kRandom, rng);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 80; ++x) left.at(y, x) = texture.at(y, x), right.at(y, x) = texture.at(y, x + 5);
  Views views(left, right, {}, 16);
  Match got(left.size());
  ref::semi_global(views.in(16, {}), got.out());
  for (int y = 0; y < 20; ++y)
    for (int x = 8; x < 70; ++x) {
      EXPECT_EQ(got.left.at(y, x), 5);
      EXPECT_EQ(got.right.at(y, x), 5);
      EXPECT_NEAR(got.fine.at(y, x), 80, 6);
      EXPECT_GT(got.margin.at(y, x), 20);
    }
}

void expect_agree(Size size, int max_disparity, const SemiGlobalParams& params, bool masked, test::Fill how) {
  std::mt19937 rng(31);
  Image<std::uint8_t> left(size), right(size), inside(size);
  test::fill(left.view(), how, rng);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      right.at(y, x) = rng() % 4 ? left.at(y, std::min(size.width - 1, x + 3)) : static_cast<std::uint8_t>(rng());
      inside.at(y, x) = rng() % 11 ? 255 : 0;
    }
  const Views views(left, right, masked ? View<const std::uint8_t>(inside) : View<const std::uint8_t>{}, max_disparity);
  const SemiGlobal in = views.in(max_disparity, params);
  Match want(size);
  ref::semi_global(in, want.out());
  // One thread and one number of several, which differs from case to case: starting threads takes longer than the work.
  const int several = 2 + (size.width + max_disparity + params.paths() + (masked ? 1 : 0)) % 4;
  test::each_target([&](const std::string& target) {
    for (const int threads : {1, several}) {
      Pool pool(threads);
      simd::SemiGlobalScratch scratch(size, max_disparity, params, threads);
      for (int frame = 0; frame < 2; ++frame) {  // a second frame must not see anything of the first
        Match got(size);
        simd::semi_global(pool, in, scratch, got.out());
        const std::string what = "semi_global " + target + " threads " + std::to_string(threads) + " N " +
                                 std::to_string(max_disparity) + " paths " + std::to_string(params.paths());
        if (!test::expect_same<std::int16_t>(want.left, got.left, what + " left") ||
            !test::expect_same<std::int16_t>(want.right, got.right, what + " right") ||
            !test::expect_same<std::uint16_t>(want.fine, got.fine, what + " fine") ||
            !test::expect_same<std::uint8_t>(want.margin, got.margin, what + " margin"))
          return;
      }
    }
  });
}

TEST(SemiGlobal, SimdAgrees) {
  for (const bool diagonals : {false, true})
    for (const bool upward : {false, true}) {
      SemiGlobalParams params;
      params.diagonals = diagonals;
      params.upward = upward;
      for (const bool masked : {false, true}) {
        expect_agree({70, 13}, 40, params, masked, test::Fill::kRandom);
        expect_agree({33, 5}, 70, params, masked, test::Fill::kRandom);
        expect_agree({34, 61}, 20, params, masked, test::Fill::kRandom);  // more rows than are held at once
        expect_agree({2, 9}, 5, params, masked, test::Fill::kRandom);
        expect_agree({1, 1}, 1, params, masked, test::Fill::kRandom);
        expect_agree({7, 9}, 3, params, masked, test::Fill::kCheckerboard);
        expect_agree({140, 3}, 128, params, masked, test::Fill::kRandom);  // what is usual
        expect_agree({130, 3}, 104, params, masked, test::Fill::kHigh);
        expect_agree({131, 4}, 129, params, masked, test::Fill::kHigh);
        expect_agree({170, 3}, 153, params, masked, test::Fill::kRandom);  // not all lanes of the first vector in use
        expect_agree({90, 3}, 96, params, masked, test::Fill::kHigh);
        if (::testing::Test::HasFailure()) return;
      }
    }
  expect_agree({40, 6}, 256, {}, true, test::Fill::kRandom);
  expect_agree({40, 6}, 64, {}, false, test::Fill::kConstant);
}

// The greatest costs and penalties that are allowed: nothing wraps.
TEST(SemiGlobal, SimdAgreesAtTheBounds) {
  SemiGlobalParams params;
  params.census_truncation = 16;
  params.truncation = 32;
  params.p1 = params.p2 = params.p2_least = 112;
  params.diagonals = params.upward = true;
  expect_agree({50, 12}, 24, params, true, test::Fill::kCheckerboard);
  expect_agree({50, 12}, 24, params, false, test::Fill::kRandom);
  expect_agree({50, 12}, 90, params, false, test::Fill::kRandom);
}

}  // namespace
}  // namespace duo
