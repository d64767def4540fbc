#include "stages/region/region.h"

#include "tests/agree.h"
#include "tests/time.h"

namespace duo {
namespace {

struct Kept {
  Image<std::uint8_t> marks;
  RegionLabel region;
};

Kept keep(const Region& in, const Image<std::uint8_t>& src) {
  Kept out{src.clone(), {}};
  out.region = ref::keep_region(in, out.marks);
  return out;
}

// By hand: three regions of bit 1: {(0,1) (0,2) (1,1)}, {(0,5) (1,5) (1,4) (2,4)} and {(2,0)}, which touches the first one only
// at a corner. Bit 0 belongs to somebody else.
const auto kThree = test::image<std::uint8_t>({{1, 2, 2, 0, 1, 3}, {0, 2, 0, 0, 2, 2}, {2, 0, 0, 0, 2, 0}});

TEST(Region, NearestToTheSeed) {
  Region in;
  in.bit = 1;
  in.window = Window::all(kThree.size());
  in.seed = {1, 1};
  const Kept on_it = keep(in, kThree);
  EXPECT_EQ(on_it.region, (RegionLabel{1, 3}));
  test::expect_same<std::uint8_t>(test::image<std::uint8_t>({{1, 2, 2, 0, 1, 1}, {0, 2, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0}}),
                                  on_it.marks, "on the first");
  in.seed = {9, -9};  // (2,0) is nearest: 81 + 49
  EXPECT_EQ(keep(in, kThree).region, (RegionLabel{12, 1}));
  in.seed = {0, 3};  // (0,2) at 1; (0,5) and (1,4) are farther
  EXPECT_EQ(keep(in, kThree).region.label, 1);
  in.seed = {2, 2};  // (1,1) at 2; (2,0) and (2,4) at 4
  EXPECT_EQ(keep(in, kThree).region.label, 1);
}

TEST(Region, EqualDistanceTakesTheFirst) {
  const auto src = test::image<std::uint8_t>({{0, 0, 1}, {0, 0, 0}, {1, 0, 0}});
  Region in;
  in.window = Window::all(src.size());
  in.seed = {1, 1};
  EXPECT_EQ(keep(in, src).region, (RegionLabel{2, 1}));
}

// By hand: the window ends the second region at its upper two rows; (2,0) outside stays.
TEST(Region, EndsAtTheWindow) {
  Region in;
  in.bit = 1;
  in.window = {0, 0, 6, 2};
  in.seed = {0, 5};
  const Kept got = keep(in, kThree);
  EXPECT_EQ(got.region, (RegionLabel{5, 3}));
  test::expect_same<std::uint8_t>(test::image<std::uint8_t>({{1, 0, 0, 0, 1, 3}, {0, 0, 0, 0, 2, 2}, {2, 0, 0, 0, 2, 0}}),
                                  got.marks, "the second");
  in.bit = 7;
  EXPECT_EQ(keep(in, kThree).region, RegionLabel{});
}

Region random_region(std::mt19937& rng, Size size) {
  const auto below = [&](int n) { return static_cast<int>(rng() % static_cast<unsigned>(n)); };
  Region in;
  in.bit = below(8);
  in.seed = {below(size.height + 6) - 3, below(size.width + 6) - 3};
  in.window = below(2) == 0 ? Window::all(size)
                            : Window{below(size.width + 4) - 4, below(size.height + 4) - 4, below(size.width + 8),
                                     below(size.height + 8)};
  return in;
}

TEST(Region, SimdAgrees) {
  std::mt19937 rng(11);
  Pool one(1), two(2), three(3);
  auto sizes = test::awkward_sizes();
  sizes.push_back({70, 150});  // several bands
  for (const Size size : sizes)
    for (int round = 0; round < 16; ++round) {
      test::Tight<std::uint8_t> src(size), want(size);
      const unsigned share = 1 + rng() % 9;
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) src.view.at(y, x) = static_cast<std::uint8_t>(rng() % 10 < share ? 0xFF : rng());
      const Region in = random_region(rng, size);
      want.pixels = src.pixels;
      const RegionLabel label = ref::keep_region(in, want.view);
      for (Pool* pool : {&one, &two, &three}) {
        test::Tight<std::uint8_t> got(size);
        got.pixels = src.pixels;
        RunForestScratch scratch(size);
        EXPECT_EQ(simd::keep_region(*pool, in, got.view, scratch), label);
        test::expect_same<std::uint8_t>(want.view, got.view, "region simd threads " + std::to_string(pool->threads()));
      }
      if (HasFailure()) return;
    }
}

TEST(Region, Time) {
  const Size size{640, 480};
  Image<std::uint8_t> blobs(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) blobs.at(y, x) = (x / 20 * 7 + y / 30 * 5) % 4 == 0;
  auto marks = blobs.clone();
  RunForestScratch scratch(size);
  Pool one(1);
  Region in;
  in.window = Window::all(size);
  in.seed = {240, 320};
  const auto run = [&] {
    for (int y = 0; y < size.height; ++y) std::copy_n(blobs.row(y), size.width, marks.row(y));
    simd::keep_region(one, in, marks, scratch);
  };
  test::print_time("region", size, run);
  in.window = {300, 200, 120, 120};
  test::print_time("region, 120x120", size, run);
}

}  // namespace
}  // namespace duo
