// The guide of a live calibration: what it reads from a view, and that who does what it says ends with a rig.
#include "duoptic/calibration_guide.h"

#include <gtest/gtest.h>

#include <cmath>

#include "duoptic/picture_figures.h"
#include "tests/guided_poses.h"

namespace duo {
namespace {

const Board kShown{.columns = 8, .rows = 6, .square_m = 0.03};
constexpr TimeNs kStep_ns = 250'000'000;

/// crooked_rig() with pictures of 400x300: whoever sees a far board needs some pixels for each square.
Rig small_rig() {
  Rig rig = test::crooked_rig();
  for (Camera* camera : {&rig.left, &rig.right}) {
    camera->size = {camera->size.width * 5 / 6, camera->size.height * 5 / 6};
    for (double* value : {&camera->fx_px, &camera->fy_px, &camera->cx_px, &camera->cy_px}) *value *= 5.0 / 6;
  }
  return rig;
}

/// A pinhole that sees 53 degrees across, as place_of() takes every camera for.
std::vector<BoardCorner> seen(const Rigid3& left_from_board, Size size) {
  std::vector<BoardCorner> out;
  for (int id = 0; id < kShown.corners(); ++id) {
    const Vec3 p_m = left_from_board * kShown.corner_m(id);
    out.push_back(
        {id, size.width * p_m.x / p_m.z + (size.width - 1) / 2.0, size.width * p_m.y / p_m.z + (size.height - 1) / 2.0});
  }
  return out;
}

TEST(BoardPlace, IsThatOfThePose) {
  const Size size{640, 480};
  // 180 x 120 mm between the outer corners, 0.6 m away: 192 x 128 px in the middle.
  const BoardPlace flat = place_of(seen(test::board_at(kShown, {0, 0, 0.6}, {}), size), kShown, size);
  EXPECT_NEAR(flat.left, 0.35, 1e-9);
  EXPECT_NEAR(flat.right, 0.65, 1e-9);
  EXPECT_NEAR(flat.top, 0.5 - 64 / 480.0, 1e-9);
  EXPECT_NEAR(flat.bottom, 0.5 + 64 / 480.0, 1e-9);
  EXPECT_NEAR(flat.size, std::sqrt(0.3 * 128 / 480), 1e-9);
  EXPECT_NEAR(flat.turned_deg, 0, 1e-3);
  EXPECT_NEAR(flat.tipped_deg, 0, 1e-3);
  // A turn around the vertical by -0.4 rad brings the left side nearer; one around the horizontal by 0.4 the top.
  constexpr double kTurn_deg = 0.4 * 180 / 3.14159265358979;
  EXPECT_NEAR(place_of(seen(test::board_at(kShown, {0.1, 0, 0.6}, {0, -0.4, 0}), size), kShown, size).turned_deg, kTurn_deg,
              0.1);
  EXPECT_NEAR(place_of(seen(test::board_at(kShown, {0, 0, 0.6}, {0.4, 0, 0}), size), kShown, size).tipped_deg, kTurn_deg, 0.1);
  // Held upside down it is the same board.
  EXPECT_NEAR(place_of(seen(test::board_at(kShown, {0, 0, 0.6}, {0, 0, 3.14159}), size), kShown, size).turned_deg, 0, 0.1);
}

class Guide : public ::testing::Test {
 protected:
  Pair drawn(const Rigid3& left_from_board) { return test::draw(kShown, rig_, left_from_board, seed_++); }
  GuideLook see(const Pair& pair) {
    pair_.left.pixels = pair.left.pixels.clone(), pair_.right.pixels = pair.right.pixels.clone();
    pair_.left.t_ns = pair_.right.t_ns = now_ns_ += kStep_ns;
    return guide_.see(pair_);
  }

  const Rig rig_ = small_rig();
  CalibrationGuide guide_{kShown, rig_.left.size};
  Pair pair_;
  TimeNs now_ns_ = 0;
  unsigned seed_ = 1;
};

TEST_F(Guide, WhoDoesWhatItSaysEndsWithARig) {
  GuideLook look = see(drawn(test::board_at(kShown, {0, 0, -1}, {})));
  EXPECT_EQ(look.step, GuideStep::kShowBoard) << look.words;
  std::size_t asked = 0;
  for (std::optional<BoardWish> wish = look.wish; wish; ++asked) {
    ASSERT_LT(asked, kBoardWishes) << words_of(*wish) << " is asked for again";
    SCOPED_TRACE(words_of(*wish));
    const Pair pair = drawn(test::guided_pose(*wish, kShown, rig_));
    EXPECT_EQ(see(pair).step, GuideStep::kHoldStill);
    const GuideLook half = see(pair);
    EXPECT_EQ(half.step, GuideStep::kHoldStill);
    EXPECT_DOUBLE_EQ(half.held, 0.5);
    const GuideLook taken = see(pair);
    ASSERT_EQ(taken.step, GuideStep::kTaken) << taken.words;
    EXPECT_TRUE(guide_.met()[static_cast<std::size_t>(*wish)]);
    EXPECT_NE(taken.wish, wish);
    wish = taken.wish;
  }
  EXPECT_TRUE(guide_.enough()) << guide_.views();
  EXPECT_EQ(see(pair_).step, GuideStep::kEnough);
  const auto found = guide_.solve();
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_NEAR(found->rig.baseline_m(), rig_.baseline_m(), 4 * found->rig.uncertainty->baseline_m + 1e-4);
  EXPECT_NEAR(found->rig.left.fx_px, rig_.left.fx_px, 4 * found->rig.uncertainty->left_focal_px);
  EXPECT_LT(found->rig.reprojection_rms_px, 0.2);
  EXPECT_EQ(guide_.shown().left.pixels.size(), rig_.left.size);
}

TEST_F(Guide, TakesNoPoseTwiceAndNoBoardThatMoves) {
  const Pair middle = drawn(test::guided_pose(BoardWish::kMiddle, kShown, rig_)),
             beside = drawn(test::guided_pose(BoardWish::kLeftNearer, kShown, rig_));
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(see(middle).step, GuideStep::kHoldStill);
    EXPECT_EQ(see(beside).step, GuideStep::kHoldStill);
  }
  EXPECT_EQ(guide_.views(), 0);
  see(beside), see(beside);
  EXPECT_EQ(guide_.views(), 1);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(see(beside).step, GuideStep::kMove);
  EXPECT_EQ(guide_.views(), 1);
  // Pictures that stop for a while say nothing of the time between.
  see(middle);
  now_ns_ += 10 * kStep_ns;
  EXPECT_EQ(see(middle).step, GuideStep::kHoldStill);
}

TEST_F(Guide, TellsWhichCameraDoesNotSeeIt) {
  Pair pair = drawn(test::guided_pose(BoardWish::kMiddle, kShown, rig_));
  const Image<Rgb8> right = std::exchange(pair.right.pixels, Image<Rgb8>(rig_.right.size));
  EXPECT_EQ(see(pair).words.rfind("Only the left camera", 0), 0u);
  pair.left.pixels = Image<Rgb8>(rig_.left.size), pair.right.pixels = right.clone();
  EXPECT_EQ(see(pair).words.rfind("Only the right camera", 0), 0u);
  EXPECT_EQ(guide_.views(), 0);
}

TEST_F(Guide, TellsCamerasThatAreSwapped) {
  Pair pair = drawn(test::guided_pose(BoardWish::kMiddle, kShown, rig_));
  EXPECT_FALSE(see(pair).perhaps_swapped);
  std::swap(pair.left, pair.right);
  EXPECT_TRUE(see(pair).perhaps_swapped);
}

TEST(PictureFigures, AreThoseWorkedOutByHand) {
  Image<Rgb8> picture({3, 3});
  picture.at(1, 1) = {100, 100, 100};
  const PictureFigures dot = picture_figures(picture);
  EXPECT_NEAR(dot.focus, 100 * 36 / std::sqrt(8), 1e-9);  // |4 * 100|, over 100 * sqrt(8) / 9
  EXPECT_NEAR(dot.brightness_percent, 100 * 100 / 9.0 / 255, 1e-9);
  EXPECT_EQ(dot.white_percent, 0);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) picture.at(y, x) = {255, 255, 255};
  const PictureFigures white = picture_figures(picture);
  EXPECT_EQ(white.focus, 0);
  EXPECT_NEAR(white.brightness_percent, 100, 1e-9);
  EXPECT_EQ(white.white_percent, 100);
}

}  // namespace
}  // namespace duo
