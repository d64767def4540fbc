// Markers of ChArUco boards. Read here and not by OpenCV's aruco module, which Debian ships only with all of contrib: 40
// packages and 330 MB, VTK and MPI among them.
#include <algorithm>
#include <bit>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "calib/find_board.h"
#include "calib/marker_bits.h"

namespace duo {
namespace {

constexpr int kCell_px = 6;  // of a bit in the straightened marker
constexpr double kMinSide_px = 8;

/// How many wrong bits a dictionary forgives.
int forgiven(int bits) { return bits == 4 ? 1 : bits == 5 ? 2 : 4; }

using Quad = std::array<cv::Point2f, 4>;

/// Dark quadrangles, clockwise.
std::vector<Quad> find_quads(const cv::Mat& gray) {
  std::vector<Quad> quads;
  const int side = std::max(gray.cols, gray.rows);
  for (const int window : {side / 64 | 1, side / 24 | 1, side / 8 | 1}) {
    cv::Mat dark;
    cv::adaptiveThreshold(gray, dark, 255, cv::ADAPTIVE_THRESH_MEAN_C, cv::THRESH_BINARY_INV, std::max(3, window), 7);
    std::vector<std::vector<cv::Point>> outlines;
    cv::findContours(dark, outlines, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
    for (const auto& outline : outlines) {
      if (static_cast<double>(outline.size()) < 4 * kMinSide_px) continue;
      std::vector<cv::Point> corners;
      cv::approxPolyDP(outline, corners, 0.04 * static_cast<double>(outline.size()), true);
      if (corners.size() != 4 || !cv::isContourConvex(corners)) continue;
      if (std::abs(cv::contourArea(corners)) < kMinSide_px * kMinSide_px) continue;
      if (cv::contourArea(corners, true) < 0) std::reverse(corners.begin(), corners.end());
      quads.push_back({corners[0], corners[1], corners[2], corners[3]});
    }
  }
  return quads;
}

/// Bits of a straightened marker, row by row; -1 when its border is not black.
std::int64_t read_bits(const cv::Mat& gray, const Quad& quad, int bits) {
  const int cells = bits + 2;
  const auto side = static_cast<float>(cells * kCell_px);
  const std::vector<cv::Point2f> square = {{0, 0}, {side, 0}, {side, side}, {0, side}};
  cv::Mat straight;
  cv::warpPerspective(gray, straight, cv::getPerspectiveTransform(std::vector<cv::Point2f>(quad.begin(), quad.end()), square),
                      {cells * kCell_px, cells * kCell_px});
  cv::threshold(straight, straight, 0, 255, cv::THRESH_BINARY | cv::THRESH_OTSU);
  std::int64_t read = 0;
  int white_border = 0;
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      const cv::Rect inner(x * kCell_px + 1, y * kCell_px + 1, kCell_px - 2, kCell_px - 2);
      const bool white = cv::mean(straight(inner))[0] > 127;
      if (x == 0 || y == 0 || x == cells - 1 || y == cells - 1)
        white_border += white;
      else
        read = read << 1 | static_cast<std::int64_t>(white);
    }
  return white_border > bits / 2 ? -1 : read;
}

std::uint64_t turned(std::uint64_t marker, int bits) {  // a quarter clockwise
  std::uint64_t out = 0;
  for (int y = 0; y < bits; ++y)
    for (int x = 0; x < bits; ++x) {
      const int from_y = bits - 1 - x, from_x = y;
      out = out << 1 | (marker >> (bits * bits - 1 - (from_y * bits + from_x)) & 1);
    }
  return out;
}

/// The marker that the bits show and how many quarters it is turned clockwise; id -1 when none is near enough.
std::pair<int, int> identify(std::uint64_t read, int bits, int count) {
  for (int id = 0; id < count; ++id) {
    std::uint64_t marker = marker_bits_of(bits, id);
    for (int quarter = 0; quarter < 4; ++quarter, marker = turned(marker, bits))
      if (std::popcount(marker ^ read) <= forgiven(bits)) return {id, quarter};
  }
  return {-1, 0};
}

}  // namespace

cv::Point2d marker_place(const Board& board, int id) {
  // White squares, row by row: those whose column and row differ in parity.
  int left = id;
  for (int row = 0; row < board.rows; ++row) {
    const int first = row % 2 == 0 ? 1 : 0, in_row = (board.columns - first + 1) / 2;
    if (left < in_row) {
      const double margin = (1 - board.marker_share) / 2;
      return {first + 2 * left - 1 + margin, row - 1 + margin};
    }
    left -= in_row;
  }
  return {};
}

std::vector<Marker> read_markers(const cv::Mat& gray, int bits, int count) {
  std::vector<Marker> found;
  for (Quad quad : find_quads(gray)) {
    const std::int64_t read = read_bits(gray, quad, bits);
    if (read < 0) continue;
    const auto [id, quarter] = identify(static_cast<std::uint64_t>(read), bits, count);
    if (id < 0 || std::any_of(found.begin(), found.end(), [id = id](const Marker& m) { return m.id == id; })) continue;
    std::rotate(quad.begin(), quad.begin() + quarter, quad.end());
    found.push_back({id, quad});
  }
  return found;
}

std::vector<Marker> markers_of_board(const std::vector<Marker>& markers, const Board& board) {
  if (markers.size() < 2) return {};
  double sides_px = 0;
  for (const Marker& marker : markers) sides_px += cv::norm(marker.corners[1] - marker.corners[0]);
  std::vector<cv::Point2f> on_board, in_picture, expected;
  for (const Marker& marker : markers) {
    const cv::Point2d place = marker_place(board, marker.id);
    const double s = board.marker_share;
    for (const cv::Point2d offset : {cv::Point2d(0, 0), cv::Point2d(s, 0), cv::Point2d(s, s), cv::Point2d(0, s)})
      on_board.emplace_back(place + offset);
    in_picture.insert(in_picture.end(), marker.corners.begin(), marker.corners.end());
  }
  const double reach_px = 0.2 * sides_px / static_cast<double>(markers.size());
  // RANSAC's own verdict is that of its best four corners, which may be four of one marker and miss the far ones; that of the
  // map refitted to all it took is the one that counts.
  const cv::Mat map = cv::findHomography(on_board, in_picture, cv::RANSAC, reach_px);
  if (map.empty()) return {};
  cv::perspectiveTransform(on_board, expected, map);
  std::vector<Marker> kept;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    double off_px = 0;
    for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) off_px = std::max(off_px, cv::norm(expected[k] - in_picture[k]));
    if (off_px <= reach_px) kept.push_back(markers[i]);
  }
  return kept;
}

std::vector<Marker> find_markers(const cv::Mat& gray, const Board& board) {
  return markers_of_board(read_markers(gray, board.marker_bits, board.columns * board.rows / 2), board);
}

}  // namespace duo
