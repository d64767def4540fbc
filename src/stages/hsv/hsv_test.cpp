#include "stages/hsv/hsv.h"

#include <cmath>

#include "tests/agree.h"
#include "tests/time.h"

namespace duo {
namespace {

struct Planes {
  test::Tight<std::uint8_t> hue, saturation, value;
  explicit Planes(Size size) : hue(size), saturation(size), value(size) {}
  HsvPlanes views() const { return {hue.view, saturation.view, value.view}; }
};

struct Hsv {
  int hue, saturation, value;
};

Hsv of(Rgb8 color) {
  const Planes dst({1, 1});
  ref::hsv(View<const Rgb8>(&color, {1, 1}, 1), dst.views());
  return {dst.hue.view.at(0, 0), dst.saturation.view.at(0, 0), dst.value.view.at(0, 0)};
}

void expect_hsv(Rgb8 color, Hsv want) {
  const Hsv got = of(color);
  EXPECT_EQ(got.hue, want.hue);
  EXPECT_EQ(got.saturation, want.saturation);
  EXPECT_EQ(got.value, want.value);
}

// By hand: (200, 100, 50): D = 150, N = 50, hue = (12800 + 450) / 900 = 14.7 -> 14, saturation = (76500 + 200) / 400 = 191.75
// -> 191. (10, 0, 1): N = -1 + 60 = 59, hue = (15104 + 30) / 60 = 252. (255, 0, 2): N = 1528, (391168 + 765) / 1530 = 256.2 ->
// 256 -> 0.
TEST(Hsv, HandWorked) {
  expect_hsv({200, 100, 50}, {14, 191, 200});
  expect_hsv({10, 0, 1}, {252, 255, 10});
  expect_hsv({255, 0, 2}, {0, 255, 255});
  expect_hsv({255, 0, 0}, {0, 255, 255});
  expect_hsv({0, 255, 0}, {85, 255, 255});   // (256 * 510 + 765) / 1530 = 85.8
  expect_hsv({0, 0, 255}, {171, 255, 255});  // (256 * 1020 + 765) / 1530 = 171.2
  expect_hsv({255, 255, 0}, {43, 255, 255});
  expect_hsv({0, 0, 0}, {0, 0, 0});
  expect_hsv({77, 77, 77}, {0, 0, 77});
}

// The definition in floating point, on a grid of colours: within half a level, around the circle.
TEST(Hsv, IsTheRoundedHexcone) {
  for (int r = 0; r < 256; r += 5)
    for (int g = 0; g < 256; g += 3)
      for (int b = 0; b < 256; b += 15) {
        const int largest = std::max({r, g, b}), chroma = largest - std::min({r, g, b});
        if (chroma == 0) continue;
        double sixth = largest == r   ? double(g - b) / chroma
                       : largest == g ? 2 + double(b - r) / chroma
                                      : 4 + double(r - g) / chroma;
        const Hsv got = of({static_cast<std::uint8_t>(r), static_cast<std::uint8_t>(g), static_cast<std::uint8_t>(b)});
        ASSERT_LE(std::abs(std::remainder(got.hue - sixth * 256 / 6, 256.0)), 0.5 + 1e-9) << r << " " << g << " " << b;
        ASSERT_LE(std::abs(got.saturation - 255.0 * chroma / largest), 0.5 + 1e-9) << r << " " << g << " " << b;
      }
}

void expect_agreement(View<const Rgb8> src) {
  Pool one(1), three(3);
  const Planes want(src.size());
  ref::hsv(src, want.views());
  test::each_target([&](const std::string& target) {
    for (Pool* pool : {&one, &three}) {
      const Planes got(src.size());
      simd::hsv(*pool, src, got.views());
      test::expect_same<std::uint8_t>(want.hue.view, got.hue.view, "hue simd " + target);
      test::expect_same<std::uint8_t>(want.saturation.view, got.saturation.view, "saturation simd " + target);
      test::expect_same<std::uint8_t>(want.value.view, got.value.view, "value simd " + target);
    }
  });
}

TEST(Hsv, SimdAgrees) {
  std::mt19937 rng(3);
  for (const Size size : test::awkward_sizes())
    for (const unsigned mask : {0xFFFFFFu, 0x010101u, 0x0F0F0Fu}) {
      test::Tight<Rgb8> src(size);
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
          const auto v = rng() & mask;
          src.view.at(y, x) = {static_cast<std::uint8_t>(v), static_cast<std::uint8_t>(v >> 8),
                               static_cast<std::uint8_t>(v >> 16)};
        }
      expect_agreement(src.view);
    }
}

// Every quotient that can occur: each hue fraction N / D in its six sectors, and each saturation D / M.
TEST(Hsv, SimdAgreesOnEveryQuotient) {
  Image<Rgb8> src({256, 256 * 7});
  const auto u8 = [](int v) { return static_cast<std::uint8_t>(v); };
  for (int chroma = 0; chroma < 256; ++chroma)
    for (int i = 0; i < 256; ++i) {
      const std::uint8_t high = 255, low = u8(255 - chroma), middle = u8(255 - chroma + std::min(i, chroma));
      const Rgb8 sectors[] = {{high, middle, low}, {middle, high, low}, {low, high, middle},
                              {low, middle, high}, {middle, low, high}, {high, low, middle}};
      for (int s = 0; s < 6; ++s) src.at(s * 256 + chroma, i) = sectors[s];
      const int value = std::max(i, chroma);
      src.at(6 * 256 + chroma, i) = {u8(value), u8(value - chroma), u8(value - chroma)};
    }
  expect_agreement(src);
}

TEST(Hsv, Time) {
  const Size size{640, 480};
  Image<Rgb8> src(size);
  std::mt19937 rng(4);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) src.at(y, x) = {static_cast<std::uint8_t>(rng()), 90, static_cast<std::uint8_t>(x)};
  Image<std::uint8_t> hue(size), saturation(size), value(size);
  Pool one(1);
  test::print_time("hsv", size, [&] { simd::hsv(one, src, {hue, saturation, value}); });
}

}  // namespace
}  // namespace duo
