#include "calib/board_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/marker_bits.h"

namespace duo {
namespace {

constexpr double kEdge_mm = 9;   // left white all around: printers do not reach it, and detection needs it
constexpr double kFoot_mm = 24;  // for ruler and words below the board
constexpr double kRuler_mm = 100, kTextSize_mm = 3.2, kLine_mm = 4.6;

/// The room that a board finds on a sheet laid one way.
struct Room {
  double page_width_mm, page_height_mm;
  double width_mm() const { return page_width_mm - 2 * kEdge_mm; }
  double height_mm() const { return page_height_mm - kEdge_mm - kFoot_mm; }
  double largest_square_mm(const Board& board) const { return std::min(width_mm() / board.columns, height_mm() / board.rows); }
};

Room best_room(const Board& board, const Paper& paper) {
  const Room upright{paper.short_mm, paper.long_mm}, lying{paper.long_mm, paper.short_mm};
  return upright.largest_square_mm(board) >= lying.largest_square_mm(board) ? upright : lying;
}

/// Black cells of a marker, each row's runs as one.
void add_marker(const Board& board, int id, double x_mm, double y_mm, double side_mm, std::vector<PageRect>& black) {
  const int bits = board.marker_bits, cells = bits + 2;
  const std::uint64_t marker = marker_bits_of(bits, id);
  const double cell_mm = side_mm / cells;
  const auto is_black = [&](int x, int y) {
    if (x == 0 || y == 0 || x == cells - 1 || y == cells - 1) return true;
    return (marker >> (bits * bits - 1 - ((y - 1) * bits + x - 1)) & 1) == 0;
  };
  for (int y = 0; y < cells; ++y)
    for (int x = 0, end = 0; x < cells; x = std::max(end, x + 1)) {
      for (end = x; end < cells && is_black(end, y);) ++end;
      if (end > x) black.push_back({x_mm + x * cell_mm, y_mm + y * cell_mm, (end - x) * cell_mm, cell_mm});
    }
}

void add_squares(const Board& board, double left_mm, double top_mm, std::vector<PageRect>& black) {
  const double square_mm = 1000 * board.square_m, margin_mm = square_mm * (1 - board.marker_share) / 2;
  int marker = 0;
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column) {
      const double x_mm = left_mm + column * square_mm, y_mm = top_mm + row * square_mm;
      if ((row + column) % 2 == 0)
        black.push_back({x_mm, y_mm, square_mm, square_mm});
      else if (board.kind == Board::Kind::kCharuco)
        add_marker(board, marker++, x_mm + margin_mm, y_mm + margin_mm, square_mm * board.marker_share, black);
    }
}

/// 100 mm from the outer side of the first tick to that of the last.
void add_ruler(double left_mm, double top_mm, BoardPage& page) {
  constexpr double kTick_mm = 0.3, kHigh_mm = 4, kLow_mm = 2;
  for (int cm = 0; cm <= 10; ++cm) {
    const double x_mm = cm == 0 ? 0 : cm == 10 ? kRuler_mm - kTick_mm : 10 * cm - kTick_mm / 2;
    page.black.push_back({left_mm + x_mm, top_mm, kTick_mm, cm % 5 == 0 ? kHigh_mm : kLow_mm});
  }
  page.black.push_back({left_mm, top_mm - kTick_mm, kRuler_mm, kTick_mm});
  page.texts.push_back({left_mm + kRuler_mm + 2, top_mm + 3, kTextSize_mm, "100 mm"});
}

}  // namespace

Result<Paper> parse_paper(std::string_view name) {
  if (name == "a4") return Paper{"A4", 210, 297};
  if (name == "letter") return Paper{"Letter", 215.9, 279.4};
  if (name == "a3") return Paper{"A3", 297, 420};
  return Error{ErrorCode::kBadInput, fmt::format("no paper '{}'; there are: a4, letter, a3", name)};
}

double largest_square_m(const Board& board, const Paper& paper) {
  return std::floor(best_room(board, paper).largest_square_mm(board)) / 1000;
}

Result<Board> largest_board(std::string_view text, const Paper& paper) {
  DUO_TRY_ASSIGN(Board board, parse_board(text, 0.01));
  board.square_m = largest_square_m(board, paper);
  if (board.square_m > 0) return board;
  return Error{ErrorCode::kBadInput, fmt::format("cannot print {} on {}: its squares would be below 1 mm; take fewer squares",
                                                 board.name(), paper.name)};
}

Result<BoardPage> lay_out_board(const Board& board, const Paper& paper) {
  const Room room = best_room(board, paper);
  const double square_mm = 1000 * board.square_m, width_mm = square_mm * board.columns, height_mm = square_mm * board.rows;
  if (width_mm > room.width_mm() + 1e-9 || height_mm > room.height_mm() + 1e-9)
    return Error{
        ErrorCode::kBadInput,
        fmt::format("cannot print {} with squares of {:.4g} mm on {}: it would be {:.4g} x {:.4g} mm; squares of {:.0f} "
                    "mm are the largest that fit, or take a larger paper",
                    board.name(), square_mm, paper.name, width_mm, height_mm, 1000 * largest_square_m(board, paper))};
  BoardPage page{room.page_width_mm, room.page_height_mm, {}, {}};
  add_squares(board, (page.width_mm - width_mm) / 2, kEdge_mm + (room.height_mm() - height_mm) / 2, page.black);
  const double left_mm = kEdge_mm + 4, foot_mm = page.height_mm - kFoot_mm + 5;
  add_ruler(left_mm, foot_mm, page);
  const std::string lines[] = {
      fmt::format("{}, squares of {:.4g} mm. Print at 100 % (\"actual size\"), tape it flat onto something stiff.",
                  board.name(), square_mm),
      fmt::format(
          "If the ruler is not 100.0 mm long, measure 5 squares with a good one and give a fifth of that as --square-mm:"),
      fmt::format("duoptic calibrate left.avi right.avi --board {} --square-mm {:.4g} -o rig.json", board.name(), square_mm)};
  double y_mm = foot_mm + 8.2;
  for (const std::string& line : lines) {
    page.texts.push_back({left_mm, y_mm, kTextSize_mm, line});
    y_mm += kLine_mm;
  }
  return page;
}

}  // namespace duo
