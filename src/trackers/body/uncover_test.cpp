// Who stands behind somebody, with the nearer one taken out.
#include <gtest/gtest.h>

#include "trackers/body/standing.h"
#include "trackers/body/uncover.h"

namespace duo::body {
namespace {

using namespace test;  // NOLINT: the made-up map

TEST(Uncover, TakesOutWhatIsNearerInABox) {
  Map map;
  map.fill({0, 0, 320, 240}, 4);
  map.fill({100, 50, 40, 30}, 1);  // somebody near
  map.fill({200, 50, 40, 30}, 1);  // and something else as near, elsewhere
  map.d_q4.at(60, 120) = Disparity::kNone;
  Image<Rgb8> picture({320, 240});
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x) picture.at(y, x) = {static_cast<std::uint8_t>(x < 120 ? 10 : 110), 0, 7};
  Uncover uncover;
  uncover.begin({map.view(), picture, 1.0 / 30, BodyModel::kLite, {}}, 4);
  uncover.take_out_before({80, 20, 90, 90}, 2);
  uncover.finish();
  const FrameView& view = uncover.view();
  // 3 cm at 2 m are 6 pixels around it.
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x) {
      const bool out = x >= 94 && x < 146 && y >= 44 && y < 86;
      ASSERT_EQ(view.is_covered({double(x), double(y)}), out) << x << " " << y;
      ASSERT_EQ(view.depth.d_q4.at(y, x), out ? Disparity::kNone : map.d_q4.at(y, x)) << x << " " << y;
      if (!out) {
        ASSERT_EQ(view.picture.at(y, x), picture.at(y, x)) << x << " " << y;
      }
    }
  // From 10 at column 93 to 110 at column 146: the middle of 53 steps.
  EXPECT_NEAR(view.picture.at(60, 119).r, 10 + 100 * 26 / 53, 1);
  EXPECT_EQ(view.picture.at(60, 119).b, 7);
  // The frame itself is as it was, and the next person begins with all of it.
  EXPECT_EQ(picture.at(60, 110).r, 10);
  uncover.begin({map.view(), picture, 1.0 / 30, BodyModel::kLite, {}}, 4);
  uncover.finish();
  EXPECT_FALSE(uncover.view().is_covered({120, 60}));
  EXPECT_EQ(uncover.view().depth.d_q4.at(55, 110), map.d_q4.at(55, 110));
}

TEST(Uncover, AtThePicturesBorderItIsFilledFromOneSide) {
  Map map;
  map.fill({0, 0, 320, 240}, 4);
  map.fill({0, 0, 50, 240}, 1);
  Image<Rgb8> picture({320, 240});
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x) picture.at(y, x) = {static_cast<std::uint8_t>(x / 2), 0, 0};
  Uncover uncover;
  uncover.begin({map.view(), picture, 1.0 / 30, BodyModel::kLite, {}}, 4);
  uncover.take_out_before({-20, -20, 400, 400}, 2);
  uncover.finish();
  EXPECT_EQ(uncover.view().picture.at(100, 0).r, 28);
  EXPECT_EQ(uncover.view().picture.at(100, 55).r, 28);
  EXPECT_EQ(uncover.view().picture.at(100, 56).r, 28);
  EXPECT_EQ(uncover.view().picture.at(100, 58).r, 29);
}

TEST(Uncover, WhoIsFartherAwayKeepsTheDepth) {
  Map map;
  map.fill({0, 0, 320, 240}, 4);
  map.fill({100, 50, 40, 30}, 1);
  Image<Rgb8> picture({320, 240});
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x) picture.at(y, x) = {static_cast<std::uint8_t>(x >= 80 && x < 180 ? 200 : 50), 0, 0};
  Uncover uncover;
  uncover.begin({map.view(), picture, 1.0 / 30, BodyModel::kLite, {}}, 1);
  uncover.take_out_behind({80, 20, 100, 100}, 2);
  uncover.finish();
  const FrameView& view = uncover.view();
  EXPECT_EQ(view.picture.at(60, 120).r, 200);  // somebody near
  EXPECT_EQ(view.picture.at(60, 99).r, 50);    // whose outline stays: it is filled from the other side alone
  EXPECT_EQ(view.picture.at(60, 140).r, 50);
  EXPECT_EQ(view.picture.at(110, 120).r, 50);  // what is behind, from both sides
  EXPECT_EQ(view.picture.at(110, 79).r, 50);
  EXPECT_FALSE(view.is_covered({120, 110}));
  EXPECT_EQ(view.depth.d_q4.at(110, 120), map.d_q4.at(110, 120));
}

}  // namespace
}  // namespace duo::body
