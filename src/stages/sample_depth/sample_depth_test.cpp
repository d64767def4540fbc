#include "stages/sample_depth/sample_depth.h"

#include "tests/areas.h"
#include "tests/time.h"

namespace duo {
namespace {

using test::kNone;

DepthSample sample(const Image<std::uint16_t>& d, const Area& area) { return ref::sample_depth(d, area); }

// By hand: known in order 10 20 20 30 500 600; of the ranks 5 / 4, 5 / 2 and 15 / 4 come 20, 20, 30.
TEST(SampleDepth, HandWorked) {
  const auto d = test::image<std::uint16_t>({{500, 20, kNone, 10}, {30, 600, 20, kNone}});
  EXPECT_EQ(sample(d, {Window::all(d.size())}), (DepthSample{8, 6, 20, 20, 30}));
  EXPECT_EQ(sample(d, {{0, 0, 1, 2}}), (DepthSample{2, 2, 30, 30, 30})) << "ranks 0, 0, 0 of 30 500";
  EXPECT_EQ(sample(d, {{2, 0, 1, 1}}), (DepthSample{1, 0, kNone, kNone, kNone}));
  EXPECT_EQ(sample(d, {{7, 7, 3, 3}}), (DepthSample{0, 0, kNone, kNone, kNone}));
}

// By hand: the disc of radius 1 around (1,1) is the plus sign 2 4 5 6 8; bit 3 marks 4 and 6 of it, all ranks 0.
TEST(SampleDepth, DiscAndMarks) {
  const auto d = test::image<std::uint16_t>({{1, 2, 3}, {4, 5, 6}, {7, 8, 9}});
  Area area{Window::all(d.size()), {1, 1, 1}};
  EXPECT_EQ(sample(d, area), (DepthSample{5, 5, 4, 5, 6}));
  const auto marks = test::image<std::uint8_t>({{8, 0, 8}, {8, 4, 9}, {0, 0, 0}});
  area.marks = marks;
  area.bits = 8;
  EXPECT_EQ(sample(d, area), (DepthSample{2, 2, 4, 4, 4}));
}

TEST(SampleDepth, SimdAgrees) {
  std::mt19937 rng(15);
  Pool one(1), two(2), three(3);
  for (const Size size : test::awkward_sizes())
    for (const unsigned range : {3u, 300u, 70000u})
      for (int round = 0; round < 8; ++round) {
        test::Tight<std::uint8_t> marks(size);
        test::Tight<std::uint16_t> d(size);
        test::fill_marks(marks.view, rng);
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x) d.view.at(y, x) = rng() % 7 == 0 ? kNone : 250 + rng() % range;
        const Area area = test::random_area(rng, size, marks.view);
        const DepthSample want = ref::sample_depth(d.view, area);
        for (Pool* pool : {&one, &two, &three}) EXPECT_EQ(simd::sample_depth(*pool, d.view, area), want);
        if (HasFailure()) return;
      }
}

TEST(SampleDepth, Time) {
  const Size size{640, 480};
  std::mt19937 rng(16);
  Image<std::uint16_t> d(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) d.at(y, x) = 300 + rng() % 500;
  Pool one(1);
  test::print_time("sample_depth", size, [&] { simd::sample_depth(one, d, {Window::all(size)}); });
  test::print_time("sample_depth, disc of radius 20", size, [&] {
    simd::sample_depth(one, d, {Window::all(size), {300, 200, 20}});
  });
}

}  // namespace
}  // namespace duo
