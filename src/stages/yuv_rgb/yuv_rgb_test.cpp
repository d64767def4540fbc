#include "stages/yuv_rgb/yuv_rgb.h"

#include "tests/agree.h"

namespace duo {
namespace {

constexpr YuvWeights kBt601{11485, -2819, -5850, 14516};

struct YuvPicture {
  YuvPicture(Size size, bool half_rows) : y(size), u({size.width / 2, half_rows ? size.height / 2 : size.height}), v(u.size()) {}
  void fill(std::mt19937& rng) {
    for (Image<std::uint8_t>* plane : {&y, &u, &v}) test::fill<std::uint8_t>(*plane, test::Fill::kRandom, rng);
  }
  YuvPlanes planes() const { return {y, u, v}; }
  Image<std::uint8_t> y, u, v;
};

View<const std::uint8_t> bytes(const Image<Rgb8>& picture) {
  return {&picture.row(0)->r, {3 * picture.width(), picture.height()}, 3 * picture.stride()};
}

TEST(YuvRgb, HandWorked) {
  YuvPicture gray({16, 16}, true);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) gray.y.at(y, x) = static_cast<std::uint8_t>(16 * y + x);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) gray.u.at(y, x) = gray.v.at(y, x) = 128;
  Image<Rgb8> out(gray.y.size());
  ref::yuv_rgb(gray.planes(), kBt601, out);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const auto v = static_cast<std::uint8_t>(16 * y + x);
      EXPECT_EQ(out.at(y, x), (Rgb8{v, v, v}));
    }
  // One sample of v is 228, 100 more: 1.402 * 100 = 140 where it is alone.
  gray.v.at(3, 2) = 228;
  ref::yuv_rgb(gray.planes(), kBt601, out);
  const auto red = [&](int y, int x) { return out.at(y, x).r - gray.y.at(y, x); };
  EXPECT_EQ(red(7, 4), 105);  // row 7 takes row 3 alone; 3 of 4 parts
  EXPECT_EQ(red(7, 3), 35);   // 1 of 4
  EXPECT_EQ(red(7, 7), 0);
  EXPECT_EQ(red(6, 5), 53);  // row 6 takes rows 2 and 3: 3 of 8 parts are 52.57
  EXPECT_EQ(red(8, 5), 53);  // rows 3 and 4
  EXPECT_EQ(red(9, 5), 0);
  EXPECT_EQ(gray.y.at(7, 4) - out.at(7, 4).g, 54);  // 5850 / 8192 * 75 = 53.6
  // Clipped.
  gray.y.at(7, 4) = 200;
  ref::yuv_rgb(gray.planes(), kBt601, out);
  EXPECT_EQ(out.at(7, 4).r, 255);
}

TEST(YuvRgb, SimdAgrees) {
  std::mt19937 rng(3);
  for (const Size size : {Size{16, 16}, Size{18, 20}, Size{62, 16}, Size{64, 18}, Size{66, 16}, Size{130, 22}})
    for (const bool half_rows : {true, false}) {
      YuvPicture planes(size, half_rows);
      planes.fill(rng);
      Image<Rgb8> want(size), got(size);
      ref::yuv_rgb(planes.planes(), kBt601, want);
      simd::YuvScratch scratch(size.width);
      test::each_target([&](const std::string& target) {
        simd::yuv_rgb(planes.planes(), kBt601, scratch, got);
        test::expect_same<std::uint8_t>(bytes(want), bytes(got), "yuv to rgb " + target);
      });
    }
}

}  // namespace
}  // namespace duo
