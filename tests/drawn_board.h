// Pictures of a calibration board as a pair of cameras would take them, for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "calib/marker_bits.h"
#include "core/lens.h"
#include "duoptic/board.h"
#include "duoptic/frame.h"

namespace duo::test {

inline Mat3 turned(Vec3 by_rad) {
  const double angle = norm(by_rad);
  const Vec3 k = angle > 0 ? (1 / angle) * by_rad : Vec3{1, 0, 0};
  const double c = std::cos(angle), s = std::sin(angle), v = 1 - c;
  return {{c + k.x * k.x * v, k.x * k.y * v - k.z * s, k.x * k.z * v + k.y * s, k.y * k.x * v + k.z * s, c + k.y * k.y * v,
           k.y * k.z * v - k.x * s, k.z * k.x * v - k.y * s, k.z * k.y * v + k.x * s, c + k.z * k.z * v}};
}

/// Two webcams mounted by hand.
inline Rig crooked_rig() {
  Rig rig;
  rig.left = {{480, 360}, 432, 433, 243, 177, {-0.11, 0.06, 8e-4, -1e-3, 0, 0, 0, 0}};
  rig.right = {{480, 360}, 426, 427, 236, 183, {-0.09, 0.04, -6e-4, 9e-4, 0, 0, 0, 0}};
  rig.right_from_left = {turned({0.02, -0.03, 0.015}), {-0.1, 0.003, -0.004}};
  return rig;
}

/// The board's middle at `middle_m`, turned around it. First inner corner at the board's origin.
inline Rigid3 board_at(const Board& board, Vec3 middle_m, Vec3 turn_rad) {
  const Mat3 rotation = turned(turn_rad);
  const Vec3 middle_on_board_m = 0.5 * board.corner_m(board.corners() - 1);
  return {rotation, middle_m - rotation * middle_on_board_m};
}

/// Twelve views, near and far, tilted to all sides, all over the pictures of crooked_rig().
inline std::vector<Rigid3> spread_poses(const Board& board) {
  std::vector<Rigid3> poses;
  for (int i = 0; i < 12; ++i) {
    const double x = 0.06 * (i % 3 - 1) + 0.05, y = 0.06 * (i / 3 % 3 - 1), z = 0.48 + 0.06 * (i % 4);
    poses.push_back(board_at(board, {x, y, z}, {0.5 * std::cos(2.4 * i), 0.5 * std::sin(2.4 * i), 0.15 * (i % 5 - 2)}));
  }
  return poses;
}

/// Brightness of the board and the wall behind it; u, v in squares from the top left of the first square.
inline double brightness(const Board& board, double u, double v) {
  constexpr double kBlack = 25, kWhite = 225, kWall = 120, kPaper = 0.8;
  if (u < -kPaper || v < -kPaper || u > board.columns + kPaper || v > board.rows + kPaper) return kWall;
  if (u < 0 || v < 0 || u >= board.columns || v >= board.rows) return kWhite;
  const int column = static_cast<int>(u), row = static_cast<int>(v);
  if ((column + row) % 2 == 0) return kBlack;
  if (board.kind == Board::Kind::kChessboard) return kWhite;
  const int cells = board.marker_bits + 2;
  const auto cell = [&](double place) {
    return static_cast<int>(std::floor((place - (1 - board.marker_share) / 2) * cells / board.marker_share));
  };
  const int x = cell(u - column), y = cell(v - row);
  if (x < 0 || y < 0 || x >= cells || y >= cells) return kWhite;
  if (x == 0 || y == 0 || x == cells - 1 || y == cells - 1) return kBlack;
  const int bits = board.marker_bits, id = (row * board.columns + column) / 2;  // whole rows before, half of them white
  const int bit = bits * bits - 1 - ((y - 1) * bits + x - 1);
  return (marker_bits_of(bits, id) >> bit & 1) != 0 ? kWhite : kBlack;
}

/// What the camera sees: nine rays a pixel, and a webcam's noise.
inline Image<Rgb8> draw(const Board& board, const Camera& camera, const Rigid3& camera_from_board, unsigned seed) {
  constexpr int kRays = 3;
  constexpr double kNoise = 1.5;
  const Lens lens(camera);
  const Vec3 normal = camera_from_board.rotation * Vec3{0, 0, 1};
  const Rigid3 board_from_camera = inverse(camera_from_board);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, kNoise);
  Image<Rgb8> out(camera.size);
  for (int y = 0; y < camera.size.height; ++y)
    for (int x = 0; x < camera.size.width; ++x) {
      double sum = 0;
      const auto ray = lens.ray_of({double(x), double(y)}), right = lens.ray_of({x + 1.0, double(y)}),
                 below = lens.ray_of({double(x), y + 1.0});
      if (!ray || !right || !below) continue;
      for (int i = 0; i < kRays * kRays; ++i) {
        const double a = (i % kRays + 0.5) / kRays - 0.5, b = (i / kRays + 0.5) / kRays - 0.5;
        const Vec3 sub = *ray + a * (*right - *ray) + b * (*below - *ray);
        const Vec3 p_m = board_from_camera * (dot(normal, camera_from_board.t_m) / dot(normal, sub) * sub);
        sum += brightness(board, p_m.x / board.square_m + 1, p_m.y / board.square_m + 1);
      }
      const auto value = static_cast<std::uint8_t>(std::clamp(sum / (kRays * kRays) + noise(random), 0.0, 255.0));
      out.at(y, x) = {value, value, value};
    }
  return out;
}

inline Pair draw(const Board& board, const Rig& rig, const Rigid3& left_from_board, unsigned seed) {
  Pair pair;
  pair.left.pixels = draw(board, rig.left, left_from_board, 2 * seed);
  pair.right.pixels = draw(board, rig.right, rig.right_from_left * left_from_board, 2 * seed + 1);
  return pair;
}

}  // namespace duo::test
