// Calibration from drawn boards, whose truth is known, and what it says of pictures that cannot give a rig.
#include "duoptic/calibrate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "calib/rectification.h"
#include "tests/drawn_board.h"

namespace duo {
namespace {

const Board kChessboard{.columns = 8, .rows = 6, .square_m = 0.03};

std::vector<Pair> draw_all(const Board& board, const Rig& rig, const std::vector<Rigid3>& poses) {
  std::vector<Pair> pairs;
  for (const Rigid3& pose : poses) pairs.push_back(test::draw(board, rig, pose, static_cast<unsigned>(pairs.size())));
  return pairs;
}

/// The twelve spread views of the chessboard; drawn once.
const std::vector<Pair>& spread_pairs() {
  static const auto pairs = draw_all(kChessboard, test::crooked_rig(), test::spread_poses(kChessboard));
  return pairs;
}

Image<Rgb8> mirrored(const Image<Rgb8>& in) {
  Image<Rgb8> out(in.size());
  for (int y = 0; y < in.height(); ++y)
    for (int x = 0; x < in.width(); ++x) out.at(y, x) = in.at(y, in.width() - 1 - x);
  return out;
}

/// Mean over a square: a lens far out of focus.
Image<Rgb8> blurred(const Image<Rgb8>& in, int radius_px) {
  Image<Rgb8> out(in.size());
  const int area = (2 * radius_px + 1) * (2 * radius_px + 1);
  for (int y = radius_px; y < in.height() - radius_px; ++y)
    for (int x = radius_px; x < in.width() - radius_px; ++x) {
      int sum = 0;
      for (int dy = -radius_px; dy <= radius_px; ++dy)
        for (int dx = -radius_px; dx <= radius_px; ++dx) sum += in.at(y + dy, x + dx).g;
      const auto mean = static_cast<std::uint8_t>(sum / area);
      out.at(y, x) = {mean, mean, mean};
    }
  return out;
}

Result<Calibration> calibrated(const std::vector<Pair>& pairs, const Board& board = kChessboard) {
  Calibrator calibrator(board, pairs.front().left.pixels.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) DUO_TRY(calibrator.add(pairs[i], "view " + std::to_string(i)));
  return calibrator.solve();
}

/// Eight spread views, each changed: enough to calibrate from.
template <typename Change>
std::vector<Pair> eight(Change change) {
  std::vector<Pair> pairs(8);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i].left.pixels = spread_pairs()[i].left.pixels.clone();
    pairs[i].right.pixels = spread_pairs()[i].right.pixels.clone();
    change(pairs[i]);
  }
  return pairs;
}

void expect_refused(const std::vector<Pair>& pairs, const std::string& word, const Board& board = kChessboard) {
  const auto result = calibrated(pairs, board);
  ASSERT_FALSE(result) << "gave a rig where it should say: " << word;
  EXPECT_NE(result.error().what.find(word), std::string::npos) << result.error().what;
  EXPECT_EQ(result.error().what.find('\n'), std::string::npos) << result.error().what;
}

/// Difference of rows, rms, of points in front of the true rig that are rectified with the found one.
double row_error_px(const Rig& truth, const Rig& found) {
  const auto geometry = rectified_geometry(found, "found");
  EXPECT_TRUE(geometry) << geometry.error().what;
  const Lens left(found.left), right(found.right), true_left(truth.left), true_right(truth.right);
  double sum = 0;
  int count = 0;
  for (const double z_m : {0.6, 1.0, 2.0})
    for (double y = -0.3; y < 0.31; y += 0.1)
      for (double x = -0.4; x < 0.41; x += 0.1) {
        const Vec3 p_m{x * z_m, y * z_m, z_m};
        const auto a = true_left.pixel_of(p_m), b = true_right.pixel_of(truth.right_from_left * p_m);
        if (!a || !b || !true_left.covers(*a) || !true_right.covers(*b)) continue;
        const auto u = rectified_from_raw(*geometry, geometry->rig_from_left, left, *a);
        const auto v = rectified_from_raw(*geometry, geometry->rig_from_right, right, *b);
        if (!u || !v) continue;
        sum += (u->y - v->y) * (u->y - v->y), ++count;
      }
  EXPECT_GT(count, 50);
  return std::sqrt(sum / count);
}

TEST(Calibrate, FindsTheRigAsWellAsItSays) {
  const Rig truth = test::crooked_rig();
  const auto result = calibrated(spread_pairs());
  ASSERT_TRUE(result) << result.error().what;
  const Rig& found = result->rig;
  ASSERT_TRUE(found.uncertainty);
  const RigUncertainty& sigma = *found.uncertainty;
  EXPECT_NEAR(found.left.fx_px, truth.left.fx_px, 3 * sigma.left_focal_px);
  EXPECT_NEAR(found.right.fx_px, truth.right.fx_px, 3 * sigma.right_focal_px);
  EXPECT_NEAR(found.baseline_m(), truth.baseline_m(), 3 * sigma.baseline_m);
  const Mat3 left_over = found.right_from_left.rotation * transposed(truth.right_from_left.rotation);
  EXPECT_NEAR(left_over(2, 1), 0, 3 * sigma.tilt_rad);
  EXPECT_NEAR(left_over(0, 2), 0, 3 * sigma.pan_rad);
  EXPECT_NEAR(left_over(1, 0), 0, 3 * sigma.roll_rad);
  // An uncertainty that covers everything would say nothing.
  EXPECT_LT(sigma.left_focal_px, 2);
  EXPECT_LT(sigma.baseline_m, 5e-4);
  EXPECT_LT(sigma.pan_rad, 3e-3);
  EXPECT_LT(found.reprojection_rms_px, 0.1);
  EXPECT_LT(found.errors.held_out_row_px, 0.15);
  EXPECT_LT(row_error_px(truth, found), 0.15);
  for (const BoardView& view : result->views) {
    EXPECT_TRUE(view.used) << view.name << ": " << view.why_not;
    EXPECT_EQ(view.left.size(), static_cast<std::size_t>(kChessboard.corners()));
  }
}

TEST(Calibrate, LeavesOutAViewThatDoesNotFit) {
  auto pairs = eight([](Pair&) {});
  pairs[3].right.pixels = spread_pairs()[9].right.pixels.clone();
  const auto result = calibrated(pairs);
  ASSERT_TRUE(result) << result.error().what;
  for (const BoardView& view : result->views) EXPECT_EQ(view.used, view.name != "view 3") << view.name << view.why_not;
  EXPECT_LT(row_error_px(test::crooked_rig(), result->rig), 0.3);
}

TEST(Calibrate, RefusesSwappedCameras) {
  expect_refused(eight([](Pair& pair) { std::swap(pair.left, pair.right); }), "swapped");
}

TEST(Calibrate, RefusesMirroredPictures) {
  expect_refused(eight([](Pair& pair) { pair.right.pixels = mirrored(pair.right.pixels); }), "mirrored");
  expect_refused(eight([](Pair& pair) {
                   pair.left.pixels = mirrored(pair.left.pixels);
                   pair.right.pixels = mirrored(pair.right.pixels);
                 }),
                 "mirrored");
}

TEST(Calibrate, RefusesTooFewViews) {
  auto pairs = eight([](Pair&) {});
  pairs.resize(4);
  expect_refused(pairs, "too few views");
}

TEST(Calibrate, RefusesViewsOfOnePose) {
  const Rigid3 pose = test::board_at(kChessboard, {0.05, 0, 0.6}, {0.1, 0.1, 0});
  expect_refused(draw_all(kChessboard, test::crooked_rig(), std::vector<Rigid3>(6, pose)), "same pose");
}

TEST(Calibrate, RefusesAnotherBoardThanNamed) {
  auto pairs = eight([](Pair&) {});
  pairs.resize(1);  // the search for what is not there takes a second
  expect_refused(pairs, "--board chessboard:7x5", {.columns = 10, .rows = 7, .square_m = 0.03});
}

TEST(Calibrate, RefusesBlurredPictures) {
  expect_refused(eight([](Pair& pair) { pair.left.pixels = blurred(pair.left.pixels, 4); }), "blurred");
}

TEST(Calibrate, RefusesMixedSizes) {
  expect_refused(eight([first = true](Pair& pair) mutable {
                   if (!first) pair.right.pixels = Image<Rgb8>({640, 480});
                   first = false;
                 }),
                 "640x480");
}

TEST(Calibrate, RefusesPairsOfDifferentMoments) {
  auto pairs = eight([](Pair&) {});
  for (std::size_t i = 0; i < 8; ++i) pairs[i].right.pixels = spread_pairs()[11 - i].right.pixels.clone();
  expect_refused(pairs, "do not belong together");
}

class Charuco : public testing::TestWithParam<const char*> {};

/// Ids and places of all corners of a drawn board, of which the right picture hides a part.
TEST_P(Charuco, FindsCornersByTheirMarkers) {
  const auto board = parse_board(GetParam(), 0.04);
  ASSERT_TRUE(board) << board.error().what;
  const Rig rig = test::crooked_rig();
  const Rigid3 pose = test::board_at(*board, {0.05, 0, 0.6}, {0.3, -0.2, 2.5});
  Pair pair = test::draw(*board, rig, pose, 1);
  for (int y = 0; y < 150; ++y)
    for (int x = 0; x < 480; ++x) pair.right.pixels.at(y, x) = {90, 90, 90};
  Calibrator calibrator(*board, rig.left.size);
  const auto view = calibrator.add(pair, "drawn");
  ASSERT_TRUE(view) << view.error().what;
  const auto corners = static_cast<std::size_t>(board->corners());
  EXPECT_EQ((*view)->left.size(), corners);
  EXPECT_GE((*view)->right.size(), corners / 4);
  EXPECT_LT((*view)->right.size(), corners);
  for (const bool left : {true, false}) {
    const Lens lens(left ? rig.left : rig.right);
    for (const BoardCorner& corner : left ? (*view)->left : (*view)->right) {
      const Vec3 p_m = pose * board->corner_m(corner.id);
      const auto truth = lens.pixel_of(left ? p_m : rig.right_from_left * p_m);
      ASSERT_TRUE(truth);
      EXPECT_NEAR(corner.x_px, truth->x, 0.3) << corner.id;
      EXPECT_NEAR(corner.y_px, truth->y, 0.3) << corner.id;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Boards, Charuco, testing::Values("charuco:7x5", "charuco:6x6:5x5", "charuco:5x7:6x6"));

TEST(Charuco, GivesARig) {
  const Board board{.kind = Board::Kind::kCharuco, .columns = 7, .rows = 5, .square_m = 0.036};
  const Rig truth = test::crooked_rig();
  auto poses = test::spread_poses(board);
  poses.resize(8);
  const auto result = calibrated(draw_all(board, truth, poses), board);
  ASSERT_TRUE(result) << result.error().what;
  EXPECT_LT(row_error_px(truth, result->rig), 0.2);
  EXPECT_NEAR(result->rig.baseline_m(), truth.baseline_m(), 3 * result->rig.uncertainty->baseline_m);
}

}  // namespace
}  // namespace duo
