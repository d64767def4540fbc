#include "calib/recognise_board.h"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "calib/find_board.h"
#include "calib/marker_bits.h"

namespace duo {
namespace {

constexpr int kLeastSquares = 3, kMostColumns = 30;
constexpr std::size_t kLeastMarkers = 4;

/// The row of squares in which a marker lies.
int row_of_marker(int id, int columns) {
  for (int row = 0;; ++row) {
    const int in_row = (columns - (row % 2 == 0 ? 1 : 0) + 1) / 2;
    if (id < in_row) return row;
    id -= in_row;
  }
}

/// The layout in which most of the markers lie where a board has them. Their numbers tell the columns, the last one the rows.
std::optional<Board> charuco_of(const std::vector<Marker>& markers, Board board) {
  std::optional<Board> best;
  std::size_t most = std::max(kLeastMarkers, markers.size() * 2 / 3) - 1;
  for (int columns = kLeastSquares; columns <= kMostColumns; ++columns) {
    board.columns = columns;
    int last = 0;
    for (const Marker& marker : markers) last = std::max(last, marker.id);
    board.rows = std::max(kLeastSquares, row_of_marker(last, columns) + 1);
    if (board.columns * board.rows / 2 > kMarkers) continue;
    const std::vector<Marker> placed = markers_of_board(markers, board);
    if (placed.size() <= most) continue;
    most = placed.size();
    last = 0;
    for (const Marker& marker : placed) last = std::max(last, marker.id);
    board.rows = std::max(kLeastSquares, row_of_marker(last, columns) + 1);
    best = board;
    if (placed.size() * 10 >= markers.size() * 9) break;
  }
  return best;
}

/// Of the dictionary of which most markers are read: those of another are read by chance, and few.
std::optional<Board> charuco_in(const cv::Mat& gray, const Board& named) {
  Board board = {.kind = Board::Kind::kCharuco, .square_m = named.square_m};
  std::vector<Marker> most;
  for (const int bits : {4, 5, 6}) {
    std::vector<Marker> markers = read_markers(gray, bits, kMarkers);
    if (markers.size() <= most.size()) continue;
    most = std::move(markers);
    board.marker_bits = bits;
  }
  return most.size() < kLeastMarkers ? std::nullopt : charuco_of(most, board);
}

/// Inner corners, the larger number first: half a turn and a quarter are the same board.
std::optional<Board> chessboard_in(const cv::Mat& gray, const Board& named, int flags) {
  std::vector<cv::Point2f> corners;
  cv::Mat seen;
  if (!cv::findChessboardCornersSB(gray, {kLeastSquares, kLeastSquares}, corners, cv::CALIB_CB_LARGER | flags, seen) ||
      seen.empty())
    return {};
  return Board{.kind = Board::Kind::kChessboard,
               .columns = std::max(seen.cols, seen.rows) + 1,
               .rows = std::min(seen.cols, seen.rows) + 1,
               .square_m = named.square_m};
}

bool same_layout(const Board& a, const Board& b) {
  const bool turned = a.kind == Board::Kind::kChessboard && a.columns == b.rows && a.rows == b.columns;
  return a.kind == b.kind && (turned || (a.columns == b.columns && a.rows == b.rows)) &&
         (a.kind == Board::Kind::kChessboard || a.marker_bits == b.marker_bits);
}

/// What was recognised is worth a word only when it works.
bool is_found(const Board& board, const cv::Mat& left, const cv::Mat& right) {
  const auto half = static_cast<std::size_t>(board.corners()) / 2;
  return find_board(left, board).corners.size() >= half && find_board(right, board).corners.size() >= half;
}

/// At first of small pictures: that is quick, and finds what is large.
cv::Mat shrunk(const cv::Mat& gray, int width) {
  if (gray.cols <= width) return gray;
  cv::Mat out;
  cv::resize(gray, out, {}, static_cast<double>(width) / gray.cols, static_cast<double>(width) / gray.cols, cv::INTER_AREA);
  return out;
}

}  // namespace

std::optional<Board> recognise_board(const cv::Mat& left, const cv::Mat& right, const Board& named) {
  constexpr int kSmall_px = 640;
  const auto works = [&](const std::optional<Board>& a, const std::optional<Board>& b) {
    return a && b && same_layout(*a, *b) && !same_layout(*a, named) && is_found(*a, left, right);
  };
  try {
    auto a = charuco_in(left, named), b = charuco_in(right, named);
    if (a && b && a->marker_bits == b->marker_bits && a->columns == b->columns) {  // the last row may be hidden in one of them
      a->rows = b->rows = std::max(a->rows, b->rows);
      return works(a, b) ? a : std::nullopt;
    }
    if (a || b) {  // one may be cut by the border; no chessboard has markers, and to look for one in them takes seconds
      for (const auto& seen : {a, b})
        if (works(seen, seen)) return seen;
      return {};
    }
    for (const int width : {std::min(kSmall_px, left.cols), left.cols}) {
      const cv::Mat small_left = shrunk(left, width), small_right = shrunk(right, width);
      std::optional<Board> largest;  // now and then a part of the board is taken for all of it
      for (const int flags : {static_cast<int>(cv::CALIB_CB_EXHAUSTIVE), 0, static_cast<int>(cv::CALIB_CB_NORMALIZE_IMAGE)}) {
        a = chessboard_in(small_left, named, flags);
        b = chessboard_in(small_right, named, flags);
        if (works(a, b)) return a;
        for (const auto& seen : {a, b})
          if (seen && (!largest || seen->corners() > largest->corners())) largest = seen;
      }
      if (works(largest, largest)) return largest;
      if (width == left.cols) break;
    }
  } catch (const cv::Exception&) {  // a picture that OpenCV cannot take has no board
  }
  return {};
}

}  // namespace duo
