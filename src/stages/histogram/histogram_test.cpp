#include "stages/histogram/histogram.h"

#include <numeric>

#include "tests/areas.h"
#include "tests/time.h"

namespace duo {
namespace {

std::uint32_t total(const ColorHistogram& histogram) {
  return std::accumulate(histogram.begin(), histogram.end(), std::uint32_t{0});
}

// By hand: (7, 8) is bin 0 * 32 + 1, (8, 7) bin 32, (255, 255) bin 1023; the fourth pixel is too dark, the fifth is not marked.
TEST(Histogram, HandWorked) {
  const auto hue = test::image<std::uint8_t>({{7, 8, 255, 7, 7, 0}});
  const auto saturation = test::image<std::uint8_t>({{8, 7, 255, 8, 8, 15}});
  const auto value = test::image<std::uint8_t>({{50, 60, 70, 49, 90, 90}});
  const auto marks = test::image<std::uint8_t>({{4, 4, 4, 4, 3, 6}});
  const ColorHistogram got = ref::color_histogram({hue, saturation, value, {Window::all(hue.size()), {}, marks, 4}, 50});
  EXPECT_EQ(got[1], 2u);
  EXPECT_EQ(got[32], 1u);
  EXPECT_EQ(got[1023], 1u);
  EXPECT_EQ(total(got), 4u);
  EXPECT_EQ(total(ref::color_histogram({hue, saturation, value, {{1, 0, 2, 1}}})), 2u);
}

// By hand: a bin at hue 0, saturation 0 spreads to hue 31 and repeats at the edge of saturation: 2 (2 + 1) = 6 stay.
TEST(Histogram, Smoothed) {
  ColorHistogram in{};
  in[0] = 10;
  in[5 * 32 + 5] = 1;
  const ColorHistogram out = smoothed(in);
  EXPECT_EQ(out[0], 60u);
  EXPECT_EQ(out[1], 20u);
  EXPECT_EQ(out[31 * 32], 30u);
  EXPECT_EQ(out[1 * 32 + 1], 10u);
  EXPECT_EQ(out[5 * 32 + 5], 4u);
  EXPECT_EQ(out[4 * 32 + 6], 1u);
  EXPECT_EQ(total(out), 16u * total(in));
}

// By hand, T = 10, O = 100. Bin 0: shares 0.6 and 0.2 -> 255 * 0.75 = 191.25 -> 191. Bin 1: 0.3 and 0.3 -> 127.5 -> 128.
// Bin 2: only the target -> 255. Bin 3: only others -> 0.
TEST(Histogram, Likelihood) {
  ColorHistogram target{}, others{};
  target[0] = 6, target[1] = 3, target[2] = 1;
  others[0] = 20, others[1] = 30, others[3] = 50;
  ColorLikelihood got = likelihood_of(target, others);
  EXPECT_EQ(got[0], 191);
  EXPECT_EQ(got[1], 128);
  EXPECT_EQ(got[2], 255);
  EXPECT_EQ(got[3], 0);
  EXPECT_EQ(got[4], 0);
  got = likelihood_of(target, others, 3);
  EXPECT_EQ(got[1], 128);
  EXPECT_EQ(got[2], 0) << "too few to say";
  EXPECT_EQ(likelihood_of(target, {})[0], 255) << "nothing else was seen";
  EXPECT_EQ(likelihood_of({}, others)[0], 0);
  target = {}, others = {};
  target[0] = others[0] = others[1] = (1 << 26) - 1;  // shares 1 and 0.5 at the largest totals
  EXPECT_EQ(likelihood_of(target, others)[0], 170);
}

TEST(Histogram, SimdAgrees) {
  std::mt19937 rng(17);
  Pool one(1), two(2), three(3);
  for (const Size size : test::awkward_sizes())
    for (int round = 0; round < 12; ++round) {
      test::Tight<std::uint8_t> hue(size), saturation(size), value(size), marks(size);
      for (const auto* plane : {&hue, &saturation, &value}) test::fill(plane->view, test::kFills[rng() % 5], rng);
      test::fill_marks(marks.view, rng);
      const ColorCount in{hue.view, saturation.view, value.view, test::random_area(rng, size, marks.view),
                          static_cast<std::uint8_t>(rng() % 200)};
      const ColorHistogram want = ref::color_histogram(in);
      for (Pool* pool : {&one, &two, &three})
        EXPECT_EQ(simd::color_histogram(*pool, in), want) << size.width << "x" << size.height;
      if (HasFailure()) return;
    }
}

TEST(Histogram, Time) {
  const Size size{640, 480};
  std::mt19937 rng(18);
  Image<std::uint8_t> hue(size), saturation(size), value(size);
  for (auto* plane : {&hue, &saturation, &value}) test::fill(plane->view(), test::Fill::kRandom, rng);
  Pool one(1);
  const auto run = [&](Window window) { simd::color_histogram(one, {hue, saturation, value, {window}}); };
  test::print_time("color_histogram", size, [&] { run(Window::all(size)); });
  test::print_time("color_histogram, 120x120", size, [&] { run({300, 200, 120, 120}); });
  ColorHistogram target{}, others{};
  for (std::uint32_t i = 0; i < kColorBins; ++i) target[i] = i, others[i] = kColorBins - i;
  test::print_time("smoothed and likelihood_of", {32, 32}, [&] { likelihood_of(smoothed(target), smoothed(others)); });
}

}  // namespace
}  // namespace duo
