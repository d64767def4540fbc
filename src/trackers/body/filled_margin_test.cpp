#include "trackers/body/filled_margin.h"

#include <gtest/gtest.h>

namespace duo::body {
namespace {

/// 40x30 px, without distortion.
Lens lens() {
  Camera camera;
  camera.size = {40, 30};
  camera.fx_px = camera.fy_px = 50;
  camera.cx_px = 20;
  camera.cy_px = 15;
  return Lens(camera);
}

/// By hand: a camera of 40x30 px without distortion in a canvas that has five pixels more on the left and eight below. Its
/// last rows and columns are mixed with black and count as margin.
TEST(FilledMargin, RepeatsThePicturesEdge) {
  Rectified rectified;
  static_cast<Pinhole&>(rectified) = {50, 25, 15, 0.1};
  rectified.size = {45, 38};
  Image<Rgb8> picture(rectified.size);
  for (int y = 0; y < 38; ++y)
    for (int x = 0; x < 45; ++x)
      picture.at(y, x) = x >= 5 && y < 30 ? Rgb8{std::uint8_t(x), std::uint8_t(y), 9} : Rgb8{0, 0, 0};
  FilledMargin margin(rectified, lens());
  const View<const Rgb8> filled = margin.fill(picture);
  for (int y = 1; y < 29; ++y)
    for (int x = 6; x < 44; ++x) ASSERT_EQ(filled.at(y, x), picture.at(y, x)) << x << " " << y;
  EXPECT_EQ(filled.at(10, 0), (Rgb8{6, 10, 9}));
  EXPECT_EQ(filled.at(37, 20), (Rgb8{20, 28, 9}));
  EXPECT_EQ(filled.at(0, 20), (Rgb8{20, 1, 9}));
  EXPECT_EQ(filled.at(20, 44), (Rgb8{43, 20, 9}));
  EXPECT_NE(margin.mask().at(37, 20), 0);
  EXPECT_EQ(margin.mask().at(20, 20), 0);
}

/// A canvas within what the camera sees is left as it is.
TEST(FilledMargin, NoneWhereTheCameraSeesAll) {
  Rectified rectified;
  static_cast<Pinhole&>(rectified) = {50, 15, 10, 0.1};
  rectified.size = {30, 20};
  const Image<Rgb8> picture(rectified.size);
  EXPECT_EQ(FilledMargin(rectified, lens()).fill(picture).data(), picture.view().data());
}

}  // namespace
}  // namespace duo::body
