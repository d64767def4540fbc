// Which board pictures show, when it is not the one that was named.
#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "duoptic/board.h"

namespace duo {

/// The board that both pictures of a pair show: a ChArUco board of any of our dictionaries, or a chessboard. find_board() finds
/// it in both of them; its squares are as large as those of `named`. None: another thing than a board, or `named` itself. Less
/// than a second for a pair.
///
/// Shape  8-bit gray
std::optional<Board> recognise_board(const cv::Mat& left, const cv::Mat& right, const Board& named);

}  // namespace duo
