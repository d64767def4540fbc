#include "calib/start_bundle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "duoptic/statistics.h"

namespace duo {
namespace {

struct OneCamera {
  Camera camera;
  std::vector<Rigid3> camera_from_board;
};

Rigid3 rigid_of(const cv::Mat& turn, const cv::Mat& move) {
  cv::Mat r;
  cv::Rodrigues(turn, r);
  Rigid3 out;
  for (int i = 0; i < 9; ++i) out.rotation.m[static_cast<std::size_t>(i)] = r.at<double>(i / 3, i % 3);
  out.t_m = {move.at<double>(0), move.at<double>(1), move.at<double>(2)};
  return out;
}

OneCamera calibrate_alone(const std::vector<const BoardView*>& views, bool left, const Board& board, Size size) {
  std::vector<std::vector<cv::Point3f>> on_board(views.size());
  std::vector<std::vector<cv::Point2f>> seen(views.size());
  for (std::size_t i = 0; i < views.size(); ++i)
    for (const BoardCorner& corner : left ? views[i]->left : views[i]->right) {
      const Vec3 p = board.corner_m(corner.id);
      on_board[i].emplace_back(static_cast<float>(p.x), static_cast<float>(p.y), 0.f);
      seen[i].emplace_back(static_cast<float>(corner.x_px), static_cast<float>(corner.y_px));
    }
  cv::Mat k, d;
  std::vector<cv::Mat> turns, moves;
  cv::calibrateCamera(on_board, seen, {size.width, size.height}, k, d, turns, moves, cv::CALIB_FIX_K3);
  OneCamera out;
  out.camera = {size, k.at<double>(0, 0), k.at<double>(1, 1), k.at<double>(0, 2), k.at<double>(1, 2), {}};
  for (int i = 0; i < 5; ++i) out.camera.distortion[static_cast<std::size_t>(i)] = d.at<double>(i);
  for (std::size_t i = 0; i < turns.size(); ++i) out.camera_from_board.push_back(rigid_of(turns[i], moves[i]));
  return out;
}

}  // namespace

double angle_rad(const Mat3& r) { return std::acos(std::clamp((r(0, 0) + r(1, 1) + r(2, 2) - 1) / 2, -1.0, 1.0)); }

Result<BundleStart> start_bundle(const std::vector<const BoardView*>& views, const Board& board, Size size) {
  try {
    const OneCamera left = calibrate_alone(views, true, board, size), right = calibrate_alone(views, false, board, size);
    BundleStart out;
    out.bundle.left = left.camera;
    out.bundle.right = right.camera;
    std::vector<Rigid3> between;
    for (std::size_t i = 0; i < views.size(); ++i) {
      between.push_back(right.camera_from_board[i] * inverse(left.camera_from_board[i]));
      out.bundle.poses.push_back({left.camera_from_board[i], {}});
    }
    // The view that agrees best with the others speaks for all.
    double best = -1;
    for (const Rigid3& candidate : between) {
      std::vector<double> turned, off;
      for (const Rigid3& other : between) {
        turned.push_back(angle_rad(candidate.rotation * transposed(other.rotation)));
        off.push_back(turned.back() + norm(candidate.t_m - other.t_m) / std::max(1e-9, norm(candidate.t_m)));
      }
      if (const double agreed = median(off); best < 0 || agreed < best) {
        best = agreed;
        out.bundle.right_from_left = candidate;
        out.pose_spread_rad = median(turned);
      }
    }
    return out;
  } catch (const cv::Exception& error) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot calibrate: no camera fits the views ({}); take other views", error.err)};
  }
}

}  // namespace duo
