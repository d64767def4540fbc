// Finding a board's corners in a picture.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "duoptic/calibrate.h"

namespace duo {

/// A board in one picture, corners in order of their ids; none = not found.
struct FoundBoard {
  std::vector<BoardCorner> corners;
  double spacing_px = 0;  // mean distance of neighbours
};

enum class BoardSearch : std::uint8_t {
  kThorough,  // what looks like a chessboard and is not found is searched for again, which takes seconds
  kQuick,     // live: large pictures are searched at half their size, and once
};

/// All corners of a chessboard, or those of a ChArUco board whose markers are seen.
///
/// Shape   8-bit gray; throws nothing
FoundBoard find_board(const cv::Mat& gray, const Board& board, BoardSearch search = BoardSearch::kThorough);

cv::Mat gray_of(const Picture& picture);

/// Markers of a ChArUco board by their ids, four corners each, clockwise from the marker's own top left.
struct Marker {
  int id = 0;
  std::array<cv::Point2f, 4> corners;
};
std::vector<Marker> find_markers(const cv::Mat& gray, const Board& board);
/// Those of the first `count` of a dictionary, wherever they lie: some may be read where there is none.
std::vector<Marker> read_markers(const cv::Mat& gray, int bits, int count);
/// Those of them that lie where the board has them.
std::vector<Marker> markers_of_board(const std::vector<Marker>& markers, const Board& board);

/// Where the marker with this id lies on its board: its top-left corner, with the first inner corner of the board at (0, 0).
///
/// Units  squares
cv::Point2d marker_place(const Board& board, int id);

/// Moves corners to where the edges of their squares cross.
///
/// Around each corner the picture is resampled along the board's own axes, and all gradients in a strip along both edges vote
/// for the point that they are orthogonal to: most of a square's length tells where the corner is, and no noise from the
/// squares' insides. On rendered boards with truth the error is two thirds of findChessboardCornersSB's and has no bias, which
/// that one has (0.5 % in focal length). Corners that run away are dropped.
///
/// Source  Förstner, Gülch, "A fast operator for detection and precise location of distinct points", 1987
void refine_corners(const cv::Mat& gray, const Board& board, FoundBoard& found);

/// How wide the edges of the squares are spread: distance from a quarter to three quarters of the step, median over edges
/// along rows or along columns, whichever is wider.
double edge_spread_px(const cv::Mat& gray, const Board& board, const FoundBoard& found);

}  // namespace duo
