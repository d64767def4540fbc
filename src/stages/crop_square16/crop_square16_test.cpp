#include "stages/crop_square16/crop_square16.h"

#include <vector>

#include "tests/agree.h"

namespace duo {
namespace {

Image<Rgb8> two_by_two() {
  Image<Rgb8> picture({2, 2});
  picture.at(0, 0) = {10, 0, 255};
  picture.at(0, 1) = {20, 0, 255};
  picture.at(1, 0) = {30, 0, 255};
  picture.at(1, 1) = {40, 0, 255};
  return picture;
}

std::vector<std::int16_t> crop(const TurnedSquare& region, Outside outside, int offset = 0, int side = 2) {
  std::vector<std::int16_t> y(side * side * 3);
  ref::crop_square16(two_by_two().view(), region, outside, offset, {y.data(), {side, side}, 3});
  return y;
}

// A square of 2 px around (0.5, 0.5): pixel for pixel.
constexpr TurnedSquare kUpright{128, 128, 256, 0};

TEST(CropSquare16, PixelForPixel) {
  EXPECT_EQ(crop(kUpright, Outside::kEdge), (std::vector<std::int16_t>{1280, 0, 32640, 2560, 0, 32640,  //
                                                                       3840, 0, 32640, 5120, 0, 32640}));
  EXPECT_EQ(crop(kUpright, Outside::kEdge, -16320)[2], 16320);
}

// By hand: right of the square is down in the picture, and down of the square is left: its first row is the right column.
TEST(CropSquare16, ATurnedSquare) {
  const std::vector<std::int16_t> y = crop({128, 128, 0, 256}, Outside::kEdge);
  EXPECT_EQ(y[0], 20 * 128);
  EXPECT_EQ(y[3], 40 * 128);
  EXPECT_EQ(y[6], 10 * 128);
  EXPECT_EQ(y[9], 30 * 128);
}

// By hand: one pixel in the middle of four: (10 + 20 + 30 + 40) / 4 = 25; half a pixel above the picture black is half of it.
TEST(CropSquare16, BetweenPixelsAndOutside) {
  EXPECT_EQ(crop({128, 128, 256, 0}, Outside::kEdge, 0, 1)[0], 25 * 128);
  EXPECT_EQ(crop({0, -128, 256, 0}, Outside::kEdge, 0, 1)[0], 10 * 128);
  EXPECT_EQ(crop({0, -128, 256, 0}, Outside::kBlack, 0, 1)[0], 5 * 128);
  EXPECT_EQ(crop({-1000, 0, 256, 0}, Outside::kBlack, 0, 1)[2], 0);
}

TEST(CropSquare16, EnginesAgree) {
  std::mt19937 rng(3);
  Pool two(2);
  for (const Size size : {Size{67, 41}, Size{1, 1}, Size{2, 1}, Size{1, 2}, Size{5, 3}}) {
    test::Tight<Rgb8> picture(size);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        picture.view.at(y, x) = {static_cast<std::uint8_t>(rng()), static_cast<std::uint8_t>(rng()),
                                 static_cast<std::uint8_t>(rng())};
    for (const int side : {1, 7, 32})
      for (const TurnedSquare region : {TurnedSquare{33 * 256, 20 * 256, 9000, -3000}, TurnedSquare{-500, 9000, -4000, 2511},
                                        TurnedSquare{200, 100, 300, 0}})
        for (const Outside outside : {Outside::kEdge, Outside::kBlack}) {
          std::vector<std::int16_t> want(side * side * 3);
          ref::crop_square16(picture.view, region, outside, -7, {want.data(), {side, side}, 3});
          test::each_target([&](const std::string& target) {
            std::vector<std::int16_t> got(side * side * 3);
            simd::crop_square16(two, picture.view, region, outside, -7, {got.data(), {side, side}, 3});
            EXPECT_EQ(want, got) << target << " " << size.width << "x" << size.height << " side " << side;
          });
        }
  }
}

}  // namespace
}  // namespace duo
