// Printed boards: their files have the true scale, our detector reads them, and OpenCV draws the same.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <regex>

#include "calib/board_page.h"
#include "duoptic/calibrate.h"
#include "duoptic/source.h"
#include "tests/write_media.h"

namespace duo {
namespace {

Board board_named(const std::string& name, double square_m) {
  const auto board = parse_board(name, square_m);
  EXPECT_TRUE(board) << board.error().what;
  return *board;
}

Paper paper_named(const char* name) {
  const auto paper = parse_paper(name);
  EXPECT_TRUE(paper);
  return *paper;
}

/// A whole number of pixels becomes one, by their mean, as a camera far away sees it.
Image<Rgb8> smaller(const Image<Rgb8>& in, int by) {
  Image<Rgb8> out({in.width() / by, in.height() / by});
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      int sum = 0;
      for (int i = 0; i < by * by; ++i) sum += in.at(by * y + i / by, by * x + i % by).g;
      const auto mean = static_cast<std::uint8_t>(sum / (by * by));
      out.at(y, x) = {mean, mean, mean};
    }
  return out;
}

Image<Rgb8> read_picture(const std::filesystem::path& path) {
  Picture picture;
  const auto source = open_source(path);
  EXPECT_TRUE(source) << source.error().what;
  EXPECT_TRUE((*source)->next(picture));
  return std::move(picture.pixels);
}

/// Corners that calibration finds in a picture.
std::vector<BoardCorner> corners_in(const Image<Rgb8>& picture, const Board& board) {
  Pair pair;
  pair.left.pixels = picture.clone(), pair.right.pixels = picture.clone();
  Calibrator calibrator(board, picture.size());
  const auto view = calibrator.add(pair, "print");
  EXPECT_TRUE(view) << view.error().what;
  EXPECT_EQ((*view)->why_not, "");
  return (*view)->left;
}

/// The rectangles of a file, as four numbers each.
std::vector<std::array<double, 4>> rectangles(const std::string& text, const std::regex& pattern) {
  std::vector<std::array<double, 4>> out;
  for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it)
    out.push_back({std::stod((*it)[1]), std::stod((*it)[2]), std::stod((*it)[3]), std::stod((*it)[4])});
  return out;
}

void expect_same(const std::vector<std::array<double, 4>>& found, const std::vector<PageRect>& truth) {
  constexpr double kNear_mm = 1e-3;
  ASSERT_EQ(found.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(found[i][0], truth[i].x_mm, kNear_mm);
    EXPECT_NEAR(found[i][1], truth[i].y_mm, kNear_mm);
    EXPECT_NEAR(found[i][2], truth[i].width_mm, kNear_mm);
    EXPECT_NEAR(found[i][3], truth[i].height_mm, kNear_mm);
  }
}

class PrintedBoard : public testing::TestWithParam<const char*> {};

TEST_P(PrintedBoard, IsFoundWhereItWasDrawn) {
  constexpr int kPixelsPerMm = 10, kSmaller = 5;
  Board board = board_named(GetParam(), 0.01);
  const Paper paper = paper_named("letter");
  board.square_m = largest_square_m(board, paper);
  const auto page = lay_out_board(board, paper);
  ASSERT_TRUE(page) << page.error().what;
  const test::TempFolder folder;
  ASSERT_TRUE(write_board(board, paper, folder / "board.png"));
  const auto corners = corners_in(smaller(read_picture(folder / "board.png"), kSmaller), board);
  ASSERT_EQ(corners.size(), static_cast<std::size_t>(board.corners()));
  const PageRect& first = page->black.front();  // the first square; the first inner corner is its lower right one
  for (const BoardCorner& corner : corners) {
    const Vec3 at_m = board.corner_m(corner.id);
    const auto pixel = [&](double mm) { return mm * kPixelsPerMm / kSmaller - 0.5; };
    EXPECT_NEAR(corner.x_px, pixel(first.x_mm + first.width_mm + 1000 * at_m.x), 0.05) << corner.id;
    EXPECT_NEAR(corner.y_px, pixel(first.y_mm + first.height_mm + 1000 * at_m.y), 0.05) << corner.id;
  }
  const std::string png = test::bytes_of(folder / "board.png");
  EXPECT_NE(png.find(std::string("pHYs\0\0\x27\x10\0\0\x27\x10\1", 13)), std::string::npos);  // 10000 pixels a metre
}

TEST_P(PrintedBoard, HasTheSameMillimetresInEveryFile) {
  const Board board = board_named(GetParam(), 0.02);
  const auto page = lay_out_board(board, paper_named("a4"));
  ASSERT_TRUE(page) << page.error().what;
  const std::string number = "(-?[0-9.e-]+)";
  expect_same(rectangles(svg_of(*page), std::regex("M" + number + " " + number + "h" + number + "v" + number + "h")),
              page->black);
  const std::string pdf = pdf_of(*page);
  expect_same(rectangles(pdf, std::regex("\n" + number + " " + number + " " + number + " " + number + " re(?=\n)")),
              page->black);
  std::smatch found;
  ASSERT_TRUE(std::regex_search(pdf, found, std::regex("MediaBox\\[0 0 " + number + " " + number + "\\]")));
  EXPECT_NEAR(std::stod(found[1]) * 25.4 / 72, page->width_mm, 1e-4);
  EXPECT_NEAR(std::stod(found[2]) * 25.4 / 72, page->height_mm, 1e-4);
  ASSERT_TRUE(std::regex_search(pdf, found, std::regex("startxref\n([0-9]+)\n")));
  EXPECT_EQ(pdf.substr(std::stoul(found[1]), 5), "xref\n");
}

INSTANTIATE_TEST_SUITE_P(Boards, PrintedBoard, testing::Values("chessboard:9x6", "charuco:9x6", "charuco:5x7:6x6"));

TEST(PrintedBoards, HaveARulerOf100Millimetres) {
  const auto page = lay_out_board(board_named("chessboard:9x6", 0.025), paper_named("a4"));
  ASSERT_TRUE(page);
  const PageRect& ruler = page->black.back();
  EXPECT_DOUBLE_EQ(ruler.width_mm, 100);
  double first_mm = 1e9, last_mm = 0;  // outer sides of the ticks that stand on it
  for (const PageRect& r : page->black)
    if (std::abs(r.y_mm - ruler.y_mm - ruler.height_mm) < 1e-9)
      first_mm = std::min(first_mm, r.x_mm), last_mm = std::max(last_mm, r.x_mm + r.width_mm);
  EXPECT_NEAR(last_mm - first_mm, 100, 1e-9);
  EXPECT_NE(page->texts.back().words.find("--board chessboard:9x6 --square-mm 25"), std::string::npos);
}

TEST(PrintedBoards, AreTheOnesThatOpenCvDraws) {
  // Drawn by cv::aruco of OpenCV 4.6: CharucoBoard::create(6, 8, 4, 3, DICT_5X5_250), 48 pixels a square. From 4.6 on boards
  // with an even number of rows begin with a black square, too.
  constexpr int kSquare_px = 48;
  const Image<Rgb8> drawn = read_picture("tests/data/opencv_charuco_6x8_5x5.png");
  const Board board = board_named("charuco:6x8:5x5", 0.028);
  const auto page = lay_out_board(board, paper_named("a4"));
  ASSERT_TRUE(page);
  const double square_mm = page->black[0].width_mm, cell_mm = square_mm * board.marker_share / 7;
  const auto is_black = [&](double x_mm, double y_mm) {
    const auto inside = [&](const PageRect& r) {
      const double x = x_mm + page->black[0].x_mm - r.x_mm, y = y_mm + page->black[0].y_mm - r.y_mm;
      return x >= 0 && y >= 0 && x < r.width_mm && y < r.height_mm;
    };
    return std::any_of(page->black.begin(), page->black.end(), inside);
  };
  for (int square = 0; square < 6 * 8; ++square)
    for (int cell = 0; cell < 7 * 7; ++cell) {
      const double margin_mm = square_mm * (1 - board.marker_share) / 2;
      const double x_mm = square % 6 * square_mm + margin_mm + (cell % 7 + 0.5) * cell_mm;
      const double y_mm = square / 6 * square_mm + margin_mm + (cell / 7 + 0.5) * cell_mm;
      const int x = static_cast<int>(x_mm / square_mm * kSquare_px), y = static_cast<int>(y_mm / square_mm * kSquare_px);
      EXPECT_EQ(is_black(x_mm, y_mm), drawn.at(y, x).g < 128) << "square " << square << " cell " << cell;
    }
  Image<Rgb8> framed({drawn.width() + 80, drawn.height() + 80});
  for (int y = 0; y < framed.height(); ++y) std::fill_n(framed.row(y), framed.width(), Rgb8{255, 255, 255});
  for (int y = 0; y < drawn.height(); ++y) std::copy_n(drawn.row(y), drawn.width(), framed.row(y + 40) + 40);
  EXPECT_EQ(corners_in(framed, board).size(), static_cast<std::size_t>(board.corners()));
}

TEST(PrintedBoards, ThatCannotBeAreRefusedInOneLine) {
  const test::TempFolder folder;
  const auto expect_refused = [&](const char* name, double square_m, const char* file, const char* words) {
    const auto written = write_board(board_named(name, square_m), paper_named("a4"), folder / file);
    ASSERT_FALSE(written);
    EXPECT_NE(written.error().what.find(words), std::string::npos) << written.error().what;
    EXPECT_EQ(written.error().what.find('\n'), std::string::npos);
    EXPECT_TRUE(std::filesystem::is_empty(folder / ""));
  };
  expect_refused("chessboard:9x6", 0.030, "board.pdf", "squares of 25 mm are the largest");
  expect_refused("chessboard:9x6", 0.020, "board.jpg", ".pdf, .svg or .png");
  expect_refused("chessboard:9x6", 0.020, "no/board.pdf", "no");
  EXPECT_FALSE(parse_paper("a5"));
}

}  // namespace
}  // namespace duo
