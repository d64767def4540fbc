#include "calib/find_board.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "duoptic/statistics.h"

namespace duo {
namespace {

/// Distance of neighbours on the board, mean over those that were found.
double spacing_px(const Board& board, const std::vector<BoardCorner>& corners) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 1; i < corners.size(); ++i)
    if (corners[i].id == corners[i - 1].id + 1 && corners[i].id % board.inner_columns() != 0) {
      sum += std::hypot(corners[i].x_px - corners[i - 1].x_px, corners[i].y_px - corners[i - 1].y_px);
      ++count;
    }
  return count > 0 ? sum / count : 0;
}

FoundBoard find_chessboard(const cv::Mat& gray, const Board& board, BoardSearch search) {
  FoundBoard found;
  const cv::Size size(board.inner_columns(), board.inner_rows());
  std::vector<cv::Point2f> corners;
  constexpr int kFlags = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE;
  if (search == BoardSearch::kQuick) {
    constexpr int kLarge_px = 960;
    const int factor = gray.cols >= kLarge_px ? 2 : 1;
    cv::Mat searched = gray;
    if (factor > 1) cv::resize(gray, searched, {}, 1.0 / factor, 1.0 / factor, cv::INTER_AREA);
    if (!cv::findChessboardCorners(searched, size, corners, kFlags | cv::CALIB_CB_FAST_CHECK)) return found;
    const float half = 0.5f * static_cast<float>(factor - 1);  // pixels of one size have their centres between those of another
    for (cv::Point2f& corner : corners) corner = static_cast<float>(factor) * corner + cv::Point2f(half, half);
  } else if (!cv::findChessboardCorners(gray, size, corners, kFlags | cv::CALIB_CB_FAST_CHECK)) {
    // Pictures without a board are told by the fast check; only those that pass it and still fail are searched the long way.
    if (!cv::checkChessboard(gray, size)) return found;
    if (!cv::findChessboardCorners(gray, size, corners, kFlags) && !cv::findChessboardCornersSB(gray, size, corners))
      return found;
  }
  for (std::size_t i = 0; i < corners.size(); ++i) found.corners.push_back({static_cast<int>(i), corners[i].x, corners[i].y});
  return found;
}

/// The four markers nearest to a corner that were seen give the map from the board to the picture around it.
FoundBoard corners_between(const std::vector<Marker>& markers, const Board& board, cv::Size size) {
  FoundBoard found;
  for (int id = 0; id < board.corners(); ++id) {
    const cv::Point2d at(id % board.inner_columns(), id / board.inner_columns());
    std::vector<std::pair<double, const Marker*>> near;
    for (const Marker& marker : markers) {
      const cv::Point2d centre = marker_place(board, marker.id) + cv::Point2d(0.5, 0.5) * board.marker_share;
      near.emplace_back(cv::norm(centre - at), &marker);
    }
    std::sort(near.begin(), near.end());
    if (near.size() > 4) near.resize(4);
    // Both markers that touch the corner: with one alone it may be hidden itself.
    if (near.size() < 2 || near[1].first > 1) continue;
    std::vector<cv::Point2f> on_board, in_picture;
    for (const auto& [distance, marker] : near) {
      const cv::Point2d place = marker_place(board, marker->id);
      const double s = board.marker_share;
      for (const cv::Point2d offset : {cv::Point2d(0, 0), cv::Point2d(s, 0), cv::Point2d(s, s), cv::Point2d(0, s)})
        on_board.emplace_back(place + offset);
      in_picture.insert(in_picture.end(), marker->corners.begin(), marker->corners.end());
    }
    const cv::Mat map = cv::findHomography(on_board, in_picture);
    if (map.empty()) continue;
    std::vector<cv::Point2f> place{at}, pixel;
    cv::perspectiveTransform(place, pixel, map);
    if (cv::Rect2f(2, 2, static_cast<float>(size.width - 5), static_cast<float>(size.height - 5)).contains(pixel[0]))
      found.corners.push_back({id, pixel[0].x, pixel[0].y});
  }
  constexpr std::size_t kEnough = 6;
  if (found.corners.size() < kEnough) found.corners.clear();
  return found;
}

}  // namespace

cv::Mat gray_of(const Picture& picture) {
  const View<const Rgb8> view = picture.pixels;
  const cv::Mat rgb(view.height(), view.width(), CV_8UC3, const_cast<Rgb8*>(view.data()),
                    static_cast<std::size_t>(view.stride()) * sizeof(Rgb8));
  cv::Mat gray;
  cv::cvtColor(rgb, gray, cv::COLOR_RGB2GRAY);
  return gray;
}

FoundBoard find_board(const cv::Mat& gray, const Board& board, BoardSearch search) {
  FoundBoard found;
  try {
    found = board.kind == Board::Kind::kChessboard ? find_chessboard(gray, board, search)
                                                   : corners_between(find_markers(gray, board), board, gray.size());
    found.spacing_px = spacing_px(board, found.corners);
    if (found.spacing_px > 0) refine_corners(gray, board, found);
  } catch (const cv::Exception&) {
    found = {};  // a picture that OpenCV cannot take has no board
  }
  return found;
}

namespace {

/// Width of the step between two neighbouring corners, measured at right angles to their edge, 9 profiles averaged.
double spread_between_px(const cv::Mat& gray, const BoardCorner& a, const BoardCorner& b, double on_before, double on_behind) {
  const cv::Point2d along(b.x_px - a.x_px, b.y_px - a.y_px), middle = {(a.x_px + b.x_px) / 2, (a.y_px + b.y_px) / 2};
  const double length = cv::norm(along), from_px = -length * on_before, to_px = length * on_behind;
  const cv::Point2d across(-along.y / length, along.x / length);
  constexpr int kSamples = 65, kMean = 9;
  cv::Mat map_x(kMean, kSamples, CV_32F), map_y(kMean, kSamples, CV_32F), patch, profile;
  for (int v = 0; v < kMean; ++v)
    for (int u = 0; u < kSamples; ++u) {
      const cv::Point2d p = middle + (from_px + (to_px - from_px) * u / (kSamples - 1)) * across +
                            (0.5 * (v + 0.5 - kMean / 2.0) / kMean) * along;
      map_x.at<float>(v, u) = static_cast<float>(p.x);
      map_y.at<float>(v, u) = static_cast<float>(p.y);
    }
  cv::remap(gray, patch, map_x, map_y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::reduce(patch, profile, 0, cv::REDUCE_AVG, CV_32F);
  double low = 0, high = 0;
  cv::minMaxLoc(profile, &low, &high);
  int between = 0;
  for (int u = 0; u < kSamples; ++u) {
    const double value = (profile.at<float>(u) - low) / std::max(1.0, high - low);
    between += value > 0.25 && value < 0.75;
  }
  return (to_px - from_px) * between / (kSamples - 1);
}

}  // namespace

double edge_spread_px(const cv::Mat& gray, const Board& board, const FoundBoard& found) {
  // On a white square the profile ends before the marker.
  const double on_black = 0.4, on_white = board.kind == Board::Kind::kCharuco ? 0.4 * (1 - board.marker_share) : on_black;
  const int columns = board.inner_columns();
  double widest_px = 0;
  for (const bool down : {false, true}) {  // apart: motion blurs the edges of one direction only
    std::vector<double> spreads;
    for (const BoardCorner& a : found.corners) {
      if (!down && (a.id + 1) % columns == 0) continue;
      const auto b = std::find_if(found.corners.begin(), found.corners.end(),
                                  [&](const BoardCorner& c) { return c.id == a.id + (down ? columns : 1); });
      if (b == found.corners.end()) continue;
      // The profile runs downwards across an edge along a row, leftwards across one along a column.
      const bool ends_black = ((a.id % columns + a.id / columns) % 2 == 0) != down;
      spreads.push_back(spread_between_px(gray, a, *b, ends_black ? on_white : on_black, ends_black ? on_black : on_white));
    }
    if (spreads.empty()) continue;
    widest_px = std::max(widest_px, median(spreads));
  }
  return widest_px;
}

}  // namespace duo
