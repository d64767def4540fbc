// Where somebody holds a board who does what a guided calibration asks for.
#pragma once

#include "duoptic/calibration_guide.h"
#include "tests/drawn_board.h"

namespace duo::test {

/// Left camera from board. Places are those between where both cameras see it; both see all of it.
inline Rigid3 guided_pose(BoardWish wish, const Board& board, const Rig& rig) {
  const Camera& left = rig.left;
  // The middle at these shares of the picture, the corners as wide as this share.
  const auto at = [&](double x, double y, double width, Vec3 turn_rad) {
    const double picture_px = left.size.width;
    const double z_m = board.square_m * (board.inner_columns() - 1) * left.fx_px / (width * picture_px);
    const double between = left.fx_px * rig.baseline_m() / z_m / picture_px;
    const double u_px = (x + between / 2) * picture_px, v_px = y * left.size.height;
    return board_at(board, {(u_px - left.cx_px) / left.fx_px * z_m, (v_px - left.cy_px) / left.fy_px * z_m, z_m}, turn_rad);
  };
  constexpr double kLeft = 0.35, kMiddle = 0.5, kRight = 0.65, kTop = 0.25, kBottom = 0.75, kUsual = 0.32;
  switch (wish) {
    case BoardWish::kMiddle:
      return at(kMiddle, 0.5, kUsual, {0.1, 0, 0});
    case BoardWish::kLeftNearer:
      return at(kMiddle, 0.5, kUsual, {0, -0.5, 0});
    case BoardWish::kRightNearer:
      return at(kMiddle, 0.5, kUsual, {0, 0.5, 0.1});
    case BoardWish::kTopNearer:
      return at(kMiddle, 0.5, kUsual, {0.5, 0, 0});
    case BoardWish::kBottomNearer:
      return at(kMiddle, 0.5, kUsual, {-0.5, 0, -0.1});
    case BoardWish::kUpperLeft:
      return at(kLeft, kTop, kUsual, {0.2, -0.2, 0});
    case BoardWish::kTop:
      return at(kMiddle, kTop, kUsual, {0.3, 0, 0});
    case BoardWish::kUpperRight:
      return at(kRight, kTop, kUsual, {0.2, 0.3, 0});
    case BoardWish::kRight:
      return at(kRight, 0.5, kUsual, {0, 0.3, 0});
    case BoardWish::kLowerRight:
      return at(kRight, kBottom, kUsual, {-0.3, 0.2, 0});
    case BoardWish::kBottom:
      return at(kMiddle, kBottom, kUsual, {-0.3, 0, 0});
    case BoardWish::kLowerLeft:
      return at(kLeft, kBottom, kUsual, {-0.2, -0.3, 0});
    case BoardWish::kLeft:
      return at(kLeft, 0.5, kUsual, {0, -0.3, 0});
    case BoardWish::kNear:
      return at(kMiddle, 0.5, 0.43, {0.2, 0.2, 0});
    case BoardWish::kFar:
      return at(kMiddle, 0.5, 0.21, {0.2, -0.2, 0});
  }
  return {};
}

}  // namespace duo::test
