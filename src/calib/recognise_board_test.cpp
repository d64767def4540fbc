// A board other than the named one is told by the first pair, and the advice works.
#include <gtest/gtest.h>

#include <string>

#include "duoptic/calibrate.h"
#include "tests/drawn_board.h"

namespace duo {
namespace {

struct BoardsCase {
  const char *named, *shown, *advice;
};
class AnotherBoard : public testing::TestWithParam<BoardsCase> {};

TEST_P(AnotherBoard, IsToldByTheFirstPairAndTheAdviceWorks) {
  const Rig rig = test::crooked_rig();
  const Board named = *parse_board(GetParam().named, 0.03), shown = *parse_board(GetParam().shown, 0.03);
  const Pair pair = test::draw(shown, rig, test::board_at(shown, {0.05, 0.01, 0.62}, {0.3, -0.2, 0.1}), 1);
  Calibrator wrong(named, rig.left.size);
  const auto refused = wrong.add(pair, "pair 1");
  ASSERT_FALSE(refused);
  const std::string advice = "give --board " + std::string(GetParam().advice);
  EXPECT_TRUE(refused.error().what.ends_with(advice)) << refused.error().what;
  EXPECT_NE(refused.error().what.find("pair 1"), std::string::npos);

  Calibrator right(*parse_board(GetParam().advice, 0.03), rig.left.size);
  const auto view = right.add(pair, "pair 1");
  ASSERT_TRUE(view) << view.error().what;
  EXPECT_TRUE((*view)->why_not.empty()) << (*view)->why_not;
}

INSTANTIATE_TEST_SUITE_P(Pairs, AnotherBoard,
                         testing::Values(BoardsCase{"chessboard:9x6", "chessboard:7x5", "chessboard:7x5"},
                                         BoardsCase{"chessboard:10x7", "chessboard:9x6", "chessboard:9x6"},
                                         BoardsCase{"chessboard:6x5", "charuco:7x5", "charuco:7x5"},
                                         BoardsCase{"charuco:9x6", "chessboard:8x5", "chessboard:8x5"},
                                         BoardsCase{"charuco:5x7", "charuco:7x5", "charuco:7x5"},
                                         BoardsCase{"charuco:7x5", "charuco:5x7", "charuco:5x7"},
                                         BoardsCase{"charuco:7x5", "charuco:7x5:5x5", "charuco:7x5:5x5"},
                                         BoardsCase{"charuco:6x4", "charuco:7x5:6x6", "charuco:7x5:6x6"}));

TEST(RecogniseBoard, TheNamedOneAndNoneAreNotOthers) {
  const Rig rig = test::crooked_rig();
  const Board board = *parse_board("chessboard:5x7", 0.03), turned = *parse_board("chessboard:7x5", 0.03);
  Calibrator calibrator(board, rig.left.size);
  EXPECT_TRUE(calibrator.add(test::draw(turned, rig, test::board_at(turned, {0.05, 0.01, 0.62}, {0.3, -0.2, 0.1}), 1), "1"));
  Calibrator nothing(board, rig.left.size);
  Pair blank;
  blank.left.pixels = Image<Rgb8>(rig.left.size);
  blank.right.pixels = Image<Rgb8>(rig.left.size);
  const auto view = nothing.add(blank, "blank");
  ASSERT_TRUE(view);
  EXPECT_EQ((*view)->why_not, "no board found");
}

}  // namespace
}  // namespace duo
