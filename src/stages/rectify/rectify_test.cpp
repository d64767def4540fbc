#include "stages/rectify/rectify.h"

#include <chrono>
#include <complex>
#include <numbers>

#include "tests/agree.h"

namespace duo {
namespace {

using Columns = ResampleMap::Columns;

struct Place {
  std::uint32_t x0, y0, fx, fy;
};
ResampleMap one_pixel(Place p) {
  ResampleMap map{Image<std::uint32_t>({1, 1}), Image<std::uint16_t>({1, 1})};
  map.corner.at(0, 0) = p.x0 << 16 | p.y0;
  map.fraction_q8.at(0, 0) = static_cast<std::uint16_t>(p.fx << 8 | p.fy);
  return map;
}

int value_at(View<const std::uint8_t> src, Place p) {
  Image<std::uint8_t> dst({1, 1}), inside({1, 1});
  ref::rectify(src, one_pixel(p), dst, inside);
  EXPECT_EQ(inside.at(0, 0), 255);
  return dst.at(0, 0);
}

// By hand, on 10 20 / 30 60: no fraction 10; half to the right 15; half down 20; the middle (10 + 20 + 30 + 60) / 4 = 30;
// fx 1/4, fy 3/4: top 12.5, bottom 37.5, 12.5 / 4 + 37.5 * 3 / 4 = 31.25 -> 31; 255/256 to both: 59.6 -> 60.
TEST(Rectify, HandWorked) {
  const auto src = test::image<std::uint8_t>({{10, 20, 99}, {30, 60, 99}, {99, 99, 99}});
  EXPECT_EQ(value_at(src, {0, 0, 0, 0}), 10);
  EXPECT_EQ(value_at(src, {0, 0, 128, 0}), 15);
  EXPECT_EQ(value_at(src, {0, 0, 0, 128}), 20);
  EXPECT_EQ(value_at(src, {0, 0, 128, 128}), 30);
  EXPECT_EQ(value_at(src, {0, 0, 64, 192}), 31);
  EXPECT_EQ(value_at(src, {0, 0, 255, 255}), 60);
  EXPECT_EQ(value_at(src, {1, 1, 255, 255}), 99);
}

// By hand: half-way between rows the weights are -1/16, 9/16, 9/16, -1/16, so of 0 10 20 40 (0 + 90 + 180 - 40) / 16 = 14.4; on
// a row it is that row; the first row continues above it: (-10 + 90 + 180 - 40) / 16 = 13.75; 0 0 250 250 rings below 0 and is
// cut.
TEST(Rectify, CubicAlongColumns) {
  EXPECT_EQ(cubic_weights(128), (std::array{-16, 144, 144, -16}));
  EXPECT_EQ(cubic_weights(0), (std::array{0, 256, 0, 0}));
  for (int f = 0; f < 256; ++f) {
    const auto w = cubic_weights(f);
    EXPECT_EQ(w[0] + w[1] + w[2] + w[3], 256) << f;
    EXPECT_NEAR(-w[0] + w[2] + 2 * w[3], f, 2) << f;  // a slope stays what it is
  }
  const auto at = [](std::initializer_list<std::initializer_list<int>> rows, Place p, Columns columns = Columns::kCubic) {
    ResampleMap map = one_pixel(p);
    map.columns = columns;
    Image<std::uint8_t> dst({1, 1}), inside({1, 1});
    ref::rectify(test::image<std::uint8_t>(rows), map, dst, inside);
    return static_cast<int>(dst.at(0, 0));
  };
  EXPECT_EQ(at({{0, 0}, {10, 10}, {20, 20}, {40, 40}}, {0, 1, 0, 128}), 14);
  EXPECT_EQ(at({{0, 0}, {10, 30}, {20, 20}, {40, 40}}, {0, 1, 128, 0}), 20);
  EXPECT_EQ(at({{10, 10}, {20, 20}, {40, 40}}, {0, 0, 0, 128}), 14);
  EXPECT_EQ(at({{0, 0}, {0, 0}, {250, 250}, {250, 250}}, {0, 0, 0, 128}), 0);
  EXPECT_EQ(at({{0, 0}, {40, 40}, {20, 20}}, {0, 1, 0, 128}), (0 + 360 + 180 - 20 + 8) / 16);  // the last row continues
  // Soft: a row is itself, and half-way as much of it goes to both sides: (10 * 10 + 236 * 20 + 10 * 90) / 256 = 22.3; the
  // first and the last row continue.
  EXPECT_EQ(soft_weights(128), (std::array{10, 236, 10, 0}));
  EXPECT_EQ(soft_weights(0), (std::array{0, 256, 0, 0}));
  EXPECT_EQ(at({{10, 10}, {20, 20}, {90, 90}}, {0, 1, 0, 128}, Columns::kSoft), 22);
  EXPECT_EQ(at({{10, 10}, {20, 40}, {90, 90}}, {0, 1, 128, 0}, Columns::kSoft), 30);
  EXPECT_EQ(at({{100, 100}, {0, 0}}, {0, 0, 0, 128}, Columns::kSoft), 96);  // 246 / 256 of 100
  EXPECT_EQ(at({{100, 100}, {0, 0}}, {0, 1, 0, 128}, Columns::kSoft), 4);
}

// Of a wave of five pixels, at any phase, a row that moves and one that stays leave the same.
TEST(Rectify, SoftBlursAsTheCubic) {
  for (int f = 0; f < 256; ++f) {
    std::complex<double> cubic, soft;
    for (int k = 0; k < 4; ++k) {
      const auto wave = std::polar(1.0 / 256, 2 * std::numbers::pi / 5 * (k - 1));
      cubic += static_cast<double>(cubic_weights(f)[static_cast<std::size_t>(k)]) * wave;
      soft += static_cast<double>(soft_weights(f)[static_cast<std::size_t>(k)]) * wave;
    }
    EXPECT_NEAR(std::abs(soft), std::abs(cubic), 0.01) << f;
  }
}

TEST(Rectify, MarksOutside) {
  const auto src = test::constant<std::uint8_t>({4, 4}, 200);
  ResampleMap map = one_pixel({0, 0, 0, 0});
  map.corner.at(0, 0) = ResampleMap::kOutside;
  auto dst = test::constant<std::uint8_t>({1, 1}, 7), inside = test::constant<std::uint8_t>({1, 1}, 7);
  ref::rectify(src, map, dst, inside);
  EXPECT_EQ(dst.at(0, 0), 0);
  EXPECT_EQ(inside.at(0, 0), 0);
}

/// Any place of the raw picture, its last ones often, and a tenth outside.
ResampleMap random_map(Size raw, Size size, std::mt19937& rng, Columns columns = Columns::kLinear) {
  ResampleMap map{Image<std::uint32_t>(size), Image<std::uint16_t>(size), columns};
  const auto place = [&](int length) {
    const auto last = static_cast<std::uint32_t>(length - 2);
    return rng() % 4 == 0 ? last - std::min<std::uint32_t>(last, rng() % 3) : static_cast<std::uint32_t>(rng() % (last + 1));
  };
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const std::uint32_t x0 = place(raw.width), y0 = place(raw.height + (columns != Columns::kLinear));
      map.corner.at(y, x) = rng() % 10 == 0 ? ResampleMap::kOutside : x0 << 16 | y0;
      map.fraction_q8.at(y, x) = static_cast<std::uint16_t>(rng());
    }
  return map;
}

TEST(Rectify, SimdAgrees) {
  std::mt19937 rng(1);
  Pool one(1), two(2);
  for (const Size raw : {Size{2, 2}, {3, 2}, {2, 5}, {4, 3}, {7, 4}, {65, 33}, {640, 480}})
    for (const Size size : test::awkward_sizes())
      for (const test::Fill how : test::kFills) {
        // Without a byte to spare at either end, so that the address sanitizer sees a read outside.
        const int stride = raw.width + 1;
        std::vector<std::uint8_t> pixels(static_cast<std::size_t>(stride * (raw.height - 1) + raw.width));
        const View<std::uint8_t> src(pixels.data(), raw, stride);
        test::fill(src, how, rng);
        const ResampleMap map = random_map(raw, size, rng, static_cast<Columns>(rng() % 3));
        test::Tight<std::uint8_t> want(size), want_inside(size);
        ref::rectify(src, map, want.view, want_inside.view);
        test::each_target([&](const std::string& target) {
          for (Pool* pool : {&one, &two}) {
            test::Tight<std::uint8_t> got(size), got_inside(size);
            simd::rectify(*pool, src, map, got.view, got_inside.view);
            const std::string what = "rectify simd " + target + " threads " + std::to_string(pool->threads());
            test::expect_same<std::uint8_t>(want.view, got.view, what);
            test::expect_same<std::uint8_t>(want_inside.view, got_inside.view, what + " inside");
          }
        });
        if (HasFailure()) return;
      }
}

TEST(Rectify, ColorIsThreeGrays) {
  std::mt19937 rng(2);
  Pool two(2);
  for (const Size raw : {Size{2, 2}, {3, 2}, {31, 17}})
    for (const Size size : test::awkward_sizes()) {
      const int stride = raw.width + 1;  // tight, as above
      std::vector<Rgb8> pixels(static_cast<std::size_t>(stride * (raw.height - 1) + raw.width));
      const View<Rgb8> src(pixels.data(), raw, stride);
      Image<std::uint8_t> channels[3] = {Image<std::uint8_t>(raw), Image<std::uint8_t>(raw), Image<std::uint8_t>(raw)};
      for (auto& channel : channels) test::fill(channel.view(), test::Fill::kRandom, rng);
      for (int y = 0; y < raw.height; ++y)
        for (int x = 0; x < raw.width; ++x) src.at(y, x) = {channels[0].at(y, x), channels[1].at(y, x), channels[2].at(y, x)};
      const ResampleMap map = random_map(raw, size, rng);
      Image<std::uint8_t> want[3] = {Image<std::uint8_t>(size), Image<std::uint8_t>(size), Image<std::uint8_t>(size)};
      Image<std::uint8_t> inside(size);
      for (int i = 0; i < 3; ++i) ref::rectify(channels[i], map, want[i], inside);
      test::each_target([&](const std::string& target) {
        test::Tight<Rgb8> got(size);
        simd::rectify(two, src, map, got.view);
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x)
            ASSERT_EQ((Rgb8{want[0].at(y, x), want[1].at(y, x), want[2].at(y, x)}), got.view.at(y, x))
                << target << " " << y << " " << x;
      });
      if (HasFailure()) return;
    }
}

// Where rows are put right a place may lie in the last row, which has none below it.
TEST(Rectify, ColorInTheLastRow) {
  std::vector<Rgb8> pixels = {{1, 2, 3}, {4, 5, 6}, {10, 20, 30}, {40, 50, 60}};
  const View<Rgb8> src(pixels.data(), {2, 2}, 2);
  ResampleMap map{Image<std::uint32_t>({1, 1}), Image<std::uint16_t>({1, 1}), ResampleMap::Columns::kCubic};
  map.corner.at(0, 0) = 1;  // x0 = 0, y0 = 1
  map.fraction_q8.at(0, 0) = 128;
  Pool one(1);
  Image<Rgb8> got({1, 1});
  simd::rectify(one, src, map, got);
  EXPECT_EQ(got.at(0, 0), (Rgb8{10, 20, 30}));
}

// A shifted, slightly turned view, as real rigs have.
TEST(Rectify, Speed) {
  const Size size{640, 480};
  ResampleMap map{Image<std::uint32_t>(size), Image<std::uint16_t>(size)};
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const double sx = 1.01 * x + 0.02 * y - 5, sy = y - 0.02 * x + 4;
      const bool seen = sx >= 0 && sy >= 0 && sx < size.width - 1 && sy < size.height - 1;
      map.corner.at(y, x) =
          seen ? static_cast<std::uint32_t>(sx) << 16 | static_cast<std::uint32_t>(sy) : ResampleMap::kOutside;
      map.fraction_q8.at(y, x) =
          static_cast<std::uint16_t>((static_cast<int>(sx * 256) & 0xFF) << 8 | (static_cast<int>(sy * 256) & 0xFF));
    }
  Image<std::uint8_t> src(size), dst(size), inside(size);
  Pool one(1);
  const auto best_ns = [](auto&& f) {
    double best = 1e9;
    for (int i = 0; i < 20; ++i) {
      const auto begin = std::chrono::steady_clock::now();
      f();
      best = std::min(best, std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count());
    }
    return best / (640 * 480);
  };
  std::printf("rectify ref: %.2f ns/pixel\n", best_ns([&] { ref::rectify(src, map, dst, inside); }));
  test::each_target([&](const std::string& target) {
    std::printf("rectify simd %s: %.2f ns/pixel\n", target.c_str(),
                best_ns([&] { simd::rectify(one, src, map, dst, inside); }));
  });
}

}  // namespace
}  // namespace duo
