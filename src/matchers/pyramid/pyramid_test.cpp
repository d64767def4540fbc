#include "matchers/pyramid/pyramid.h"

#include <random>

#include "tests/agree.h"

namespace duo {
namespace {

// The thesis counts 9,196,800 comparisons for 640x480: 80*60*80 + 160*120*7 + 320*240*13 + 640*480*25. Flat pictures are
// enough: the number does not depend on what is found.
TEST(Pyramid, ThesisComparesAsOftenAsTheThesis) {
  const PyramidParams params = *pyramid_params("thesis", {});
  const std::vector<PyramidLevel> levels = make_levels(params, {{640, 480}, 128, false});
  std::int64_t comparisons = 0;
  Image<std::int16_t> coarser;
  for (int i = params.levels - 1; i >= 0; --i) {
    const Size size = levels[static_cast<std::size_t>(i)].size;
    const Image<std::uint8_t> flat(size);
    Image<std::int16_t> winner(size);
    MatchAround in{flat, flat};
    in.coarser = coarser;
    in.radius = radius_of(params, i);
    ref::match_around(in, winner, &comparisons);
    coarser = std::move(winner);
  }
  EXPECT_EQ(comparisons, 9'196'800);
}

/// A textured wall at 4 px with a box at 12 px in front of its middle third.
struct Scene {
  Image<std::uint8_t> left, right;
  explicit Scene(Size size, unsigned seed) : left(size), right(size) {
    std::mt19937 rng(seed);
    Image<std::uint8_t> texture({size.width + 64, size.height});
    test::fill(texture.view(), test::Fill::kRandom, rng);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        left.at(y, x) = texture.at(y, x);
        right.at(y, x) = texture.at(y, x + (x * 3 > size.width && x * 3 < 2 * size.width ? 12 : 4));
      }
  }
};

void expect_engines_agree(Size size, int max_disparity, const char* preset, bool masked) {
  const Scene scene(size, 21);
  const PyramidParams params = *pyramid_params(preset, {});
  Image<std::uint8_t> inside = test::constant<std::uint8_t>(size, 255);
  for (int y = 0; y < size.height; ++y) inside.at(y, 0) = 0;
  GrayPair pair{scene.left, scene.right};
  if (masked) pair.left_inside = inside, pair.right_inside = inside;
  const MatchSetup setup{size, max_disparity, masked};
  StageTimer timer;
  Image<std::uint16_t> want(size);
  ref::Pyramid(params, setup).match(pair, {want}, timer);
  test::each_target([&](const std::string& target) {
    for (const int threads : {1, 2, 3}) {
      Pool pool(threads);
      Image<std::uint16_t> got(size);
      simd::Pyramid matcher(pool, params, setup);
      for (int frame = 0; frame < 2; ++frame) {  // a second frame must not see anything of the first
        matcher.match(pair, {got}, timer);
        test::expect_same<std::uint16_t>(
            want, got, std::string("pyramid ") + preset + " simd " + target + " threads " + std::to_string(threads));
      }
    }
  });
}

TEST(Pyramid, DefaultAgrees) {
  for (const bool masked : {false, true}) {
    expect_engines_agree({150, 70}, 40, "default", masked);
    expect_engines_agree({33, 17}, 64, "default", masked);
    expect_engines_agree({1, 1}, 1, "default", masked);
    expect_engines_agree({5, 40}, 3, "default", masked);
  }
}

TEST(Pyramid, ThesisAgrees) {
  for (const bool masked : {false, true}) {
    expect_engines_agree({150, 70}, 40, "thesis", masked);
    expect_engines_agree({33, 17}, 64, "thesis", masked);
    expect_engines_agree({1, 1}, 1, "thesis", masked);
  }
}

TEST(Pyramid, FindsTheBox) {
  const Size size{150, 70};
  const Scene scene(size, 22);
  Image<std::uint16_t> got(size);
  StageTimer timer;
  ref::Pyramid(*pyramid_params("default", {}), {size, 32, false}).match({scene.left, scene.right}, {got}, timer);
  EXPECT_NEAR(got.at(35, 80), 12 * 16, 4);
  EXPECT_NEAR(got.at(35, 30), 4 * 16, 4);
}

TEST(Pyramid, ParametersAreChecked) {
  EXPECT_FALSE(pyramid_params("no such preset", {}));
  EXPECT_FALSE(pyramid_params("default", {{"no such name", 1}}));
  EXPECT_FALSE(pyramid_params("default", {{"levels", 0}}));
  EXPECT_FALSE(pyramid_params("default", {{"levels", 2.5}}));
  EXPECT_FALSE(pyramid_params("default", {{"levels", std::numeric_limits<double>::quiet_NaN()}}));
  EXPECT_EQ(pyramid_params("default", {{"levels", 2}})->levels, 2);
}

}  // namespace
}  // namespace duo
