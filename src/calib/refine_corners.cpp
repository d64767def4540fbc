#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "calib/find_board.h"

namespace duo {
namespace {

constexpr double kBlur_px = 1;        // pixels err alone, edges do not
constexpr double kStep_px = 0.7;      // of the resampled patch
constexpr double kReach = 0.75;       // along the edges, of a square; the next corner is at 1
constexpr double kOuterReach = 0.35;  // outwards from the outermost corners: many boards have their outer squares cut
constexpr double kMaxMove = 0.3;      // of a square, from where the corner was found

/// Map from the board, in squares around the corner, to the picture, from the corner's neighbours; empty when they do not span
/// it. The nearest ones when there are enough: a lens bends what lies further off.
cv::Mat local_map(const Board& board, const FoundBoard& found, const BoardCorner& corner) {
  const int columns = board.inner_columns();
  for (const int reach : {1, 2}) {
    std::vector<cv::Point2f> on_board, in_picture;
    for (const BoardCorner& other : found.corners) {
      const int dx = other.id % columns - corner.id % columns, dy = other.id / columns - corner.id / columns;
      if (std::max(std::abs(dx), std::abs(dy)) > reach) continue;
      on_board.emplace_back(static_cast<float>(dx), static_cast<float>(dy));
      in_picture.emplace_back(static_cast<float>(other.x_px), static_cast<float>(other.y_px));
    }
    if (on_board.size() >= 6) return cv::findHomography(on_board, in_picture);
  }
  return {};
}

/// What around a corner is sure to look like a chessboard, in squares; as far to one side as to the other, because noise pulls
/// towards the middle of what is looked at.
cv::Rect2d sure_part(const Board& board, int id) {
  const int x = id % board.inner_columns(), y = id / board.inner_columns();
  const double across = x == 0 || x == board.inner_columns() - 1 ? kOuterReach : kReach;
  const double down = y == 0 || y == board.inner_rows() - 1 ? kOuterReach : kReach;
  return {-across, -down, 2 * across, 2 * down};
}

/// The point that the gradients beside both edges are orthogonal to, in pixels from the patch's centre.
std::optional<cv::Point2d> crossing(const cv::Mat& patch, cv::Point2d start, cv::Rect2d part, double pixels_a_square,
                                    double strip) {
  const int half = patch.cols / 2;
  cv::Point2d at = start;
  for (int round = 0; round < 4; ++round) {
    double xx = 0, xy = 0, yy = 0, bx = 0, by = 0;
    for (int y = 1; y < patch.rows - 1; ++y)
      for (int x = 1; x < patch.cols - 1; ++x) {
        const double u = (x - half - at.x) / pixels_a_square, v = (y - half - at.y) / pixels_a_square;
        if (std::min(std::abs(u), std::abs(v)) > strip || !part.contains({u, v})) continue;
        const double gx = patch.at<float>(y, x + 1) - patch.at<float>(y, x - 1);
        const double gy = patch.at<float>(y + 1, x) - patch.at<float>(y - 1, x);
        const double px = x - half, py = y - half;
        xx += gx * gx, xy += gx * gy, yy += gy * gy;
        bx += gx * gx * px + gx * gy * py;
        by += gx * gy * px + gy * gy * py;
      }
    const double det = xx * yy - xy * xy;
    if (!(det > 1e-3 * (xx + yy) * (xx + yy))) return {};
    at = {(yy * bx - xy * by) / det, (xx * by - xy * bx) / det};
    if (!(cv::norm(at - start) < kMaxMove * pixels_a_square)) return {};
  }
  return at;
}

}  // namespace

void refine_corners(const cv::Mat& gray, const Board& board, FoundBoard& found) {
  cv::Mat smooth;
  gray.convertTo(smooth, CV_32F);
  cv::GaussianBlur(smooth, smooth, {0, 0}, kBlur_px);
  // Beside the edge of a white square lies its marker; gradients of that one must not vote.
  const double margin = board.kind == Board::Kind::kCharuco ? (1 - board.marker_share) / 2 : 0.5;
  const std::vector<BoardCorner> start = found.corners;
  for (int round = 0; round < 2; ++round) {
    std::vector<BoardCorner> moved;
    for (const BoardCorner& corner : found.corners) {
      const cv::Mat map = local_map(board, found, corner);
      if (map.empty()) continue;
      const int half = std::max(6, static_cast<int>(std::lround(kReach * found.spacing_px / kStep_px)));
      const double pixels_a_square = half / kReach;
      const cv::Mat squares_from_patch =
          (cv::Mat_<double>(3, 3) << 1 / pixels_a_square, 0, -kReach, 0, 1 / pixels_a_square, -kReach, 0, 0, 1);
      const cv::Mat picture_from_patch = map * squares_from_patch;
      cv::Mat patch;
      cv::warpPerspective(smooth, patch, picture_from_patch, {2 * half + 1, 2 * half + 1},
                          cv::INTER_CUBIC | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
      const double strip = std::min(0.6 * margin, 4 / found.spacing_px);
      std::vector<cv::Point2d> from{{corner.x_px, corner.y_px}}, to;
      cv::perspectiveTransform(from, to, picture_from_patch.inv());
      const auto at = crossing(patch, to[0] - cv::Point2d(half, half), sure_part(board, corner.id), pixels_a_square, strip);
      if (!at) continue;
      from[0] = *at + cv::Point2d(half, half);
      cv::perspectiveTransform(from, to, picture_from_patch);
      moved.push_back({corner.id, to[0].x, to[0].y});
    }
    found.corners = std::move(moved);
  }
  std::erase_if(found.corners, [&](const BoardCorner& corner) {
    for (const BoardCorner& before : start)
      if (before.id == corner.id)
        return std::hypot(before.x_px - corner.x_px, before.y_px - corner.y_px) > kMaxMove * found.spacing_px;
    return true;
  });
}

}  // namespace duo
