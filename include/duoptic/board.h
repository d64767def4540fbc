// Calibration boards: chessboards and ChArUco boards, as they are named and measured.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "duoptic/geometry.h"
#include "duoptic/result.h"

namespace [[gnu::visibility("default")]] duo {

/// A flat pattern of squares, black in the top-left corner. On a ChArUco board each white square holds a marker, numbered row
/// by row, of OpenCV's dictionaries DICT_4X4, 5X5 or 6X6 (the first 250, which all their lengths share), laid out as OpenCV
/// does from 4.6 on.
///
/// Units   metres on the paper; corners are the inner ones, numbered row by row from the top left, x right, y down
/// Source  Garrido-Jurado et al., "Automatic generation and detection of highly reliable fiducial markers under occlusion",
/// 2014
struct Board {
  enum class Kind : std::uint8_t { kChessboard, kCharuco };
  Kind kind = Kind::kChessboard;
  int columns = 10, rows = 7;  // squares
  double square_m = 0.03;
  int marker_bits = 4;         // a marker has that many bits a side, and a black border of one more on each
  double marker_share = 0.75;  // side of a marker with its border, of a square's

  int inner_columns() const { return columns - 1; }
  int inner_rows() const { return rows - 1; }
  int corners() const { return inner_columns() * inner_rows(); }
  Vec3 corner_m(int id) const { return {square_m * (id % inner_columns()), square_m * (id / inner_columns()), 0}; }
  /// As parse_board() reads it.
  std::string name() const;
};

/// Reads "chessboard:9x6" (inner corners) or "charuco:9x6" (squares), the latter perhaps with its dictionary:
/// "charuco:9x6:5x5".
///
/// Errors  another text; fewer than 3x3 or more than 50x50 squares; more markers than the dictionary has; a square outside
/// 1 mm .. 1 m
Result<Board> parse_board(std::string_view text, double square_m);

/// A sheet, upright or lying, whichever takes the larger board.
struct Paper {
  std::string name;
  double short_mm = 0, long_mm = 0;
};

/// "a4", "letter" or "a3".
///
/// Errors  another name
Result<Paper> parse_paper(std::string_view name);

/// The largest square of whole millimetres with which the board fits the paper; 0 = none does.
double largest_square_m(const Board& board, const Paper& paper);

/// The board as it is printed where nobody says how large its squares are, and so as it is calibrated with: the largest whole
/// ones that fit.
///
/// Errors  those of parse_board(); squares below 1 mm
Result<Board> largest_board(std::string_view text, const Paper& paper);

/// Writes the board for printing, in true scale, with its name, a ruler of 100 mm and how to measure it. The ending of `path`
/// decides: SVG and PDF have one vector path; PNG has 10 pixels a millimetre and says so. On stdout it is a PDF.
///
/// Errors  another ending; the board does not fit the paper; those of every written file
Result<void> write_board(const Board& board, const Paper& paper, const std::filesystem::path& path);

}  // namespace duo
