#include "duoptic/board.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "calib/marker_bits.h"

namespace duo {
namespace {

constexpr int kMinSquares = 3, kMaxSquares = 50;

}  // namespace

std::string Board::name() const {
  if (kind == Kind::kChessboard) return fmt::format("chessboard:{}x{}", inner_columns(), inner_rows());
  const std::string squares = fmt::format("charuco:{}x{}", columns, rows);
  return marker_bits == 4 ? squares : fmt::format("{}:{}x{}", squares, marker_bits, marker_bits);
}

Result<Board> parse_board(std::string_view text, double square_m) {
  const std::string name(text);
  const auto refused = [&](const std::string& why) {
    return Error{ErrorCode::kBadInput, fmt::format("cannot use board '{}': {}", name, why)};
  };
  Board board{.square_m = square_m};
  int bits_across = 4, bits_down = 4, read = 0;
  const auto all_read = [&] { return read == static_cast<int>(name.size()); };
  if (std::sscanf(name.c_str(), "chessboard:%4dx%4d%n", &board.columns, &board.rows, &read) == 2 && all_read()) {
    ++board.columns, ++board.rows;
  } else {
    board.kind = Board::Kind::kCharuco;
    read = 0;
    const bool plain = std::sscanf(name.c_str(), "charuco:%4dx%4d%n", &board.columns, &board.rows, &read) == 2 && all_read();
    if (!plain && !(std::sscanf(name.c_str(), "charuco:%4dx%4d:%4dx%4d%n", &board.columns, &board.rows, &bits_across,
                                &bits_down, &read) == 4 &&
                    all_read()))
      return refused("write chessboard:9x6 (inner corners) or charuco:9x6 (squares), charuco:9x6:5x5 for other markers");
  }
  if (bits_across != bits_down || bits_across < 4 || bits_across > 6) return refused("there are markers of 4x4, 5x5 and 6x6");
  board.marker_bits = bits_across;
  if (std::min(board.columns, board.rows) < kMinSquares || std::max(board.columns, board.rows) > kMaxSquares)
    return refused(fmt::format("it would have {}x{} squares; 3x3 to 50x50 will do", board.columns, board.rows));
  if (board.kind == Board::Kind::kCharuco && board.columns * board.rows / 2 > kMarkers)
    return refused(fmt::format("it needs more than the {} markers there are; take fewer squares", kMarkers));
  if (!(square_m >= 0.001 && square_m <= 1))
    return refused(fmt::format("its squares would measure {:.4g} mm; 1 to 1000 mm will do", 1000 * square_m));
  return board;
}

}  // namespace duo
