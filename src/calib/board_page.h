// A board on its sheet of paper: what is black and what is written, in millimetres from the top left.
#pragma once

#include <string>
#include <vector>

#include "duoptic/board.h"

namespace duo {

struct PageRect {
  double x_mm, y_mm, width_mm, height_mm;
};

struct PageText {
  double x_mm, y_mm;  // where its base line begins
  double size_mm;     // of the font
  std::string words;  // ASCII
};

struct BoardPage {
  double width_mm = 0, height_mm = 0;
  std::vector<PageRect> black;  // no two overlap
  std::vector<PageText> texts;
};

/// Errors  the board does not fit
Result<BoardPage> lay_out_board(const Board& board, const Paper& paper);

/// The page as a file of each kind.
std::string svg_of(const BoardPage& page);
std::string pdf_of(const BoardPage& page);
std::string png_page(const BoardPage& page);

}  // namespace duo
