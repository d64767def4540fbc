// Where the pixels of a turned square lie in its picture.
#pragma once

#include <array>
#include <cstdint>

#include "duoptic/detector.h"

namespace duo {

/// Columns and rows of the square, 1/65536 px: a pixel's place is the sum of both.
class CropGrid {
 public:
  static constexpr int kMostSide = 1024;

  CropGrid(const TurnedSquare& region, int side) : region_(region), side_(side) {
    for (int j = 0; j < side; ++j) {
      const std::int64_t k = 256 * (2 * j + 1 - side);
      column_x_[j] = 256 * region.x_q8 + quotient(k * region.right_x_q8);
      column_y_[j] = 256 * region.y_q8 + quotient(k * region.right_y_q8);
    }
  }
  void set_row(int i) {
    const std::int64_t l = 256 * (2 * i + 1 - side_);
    row_x_ = quotient(-l * region_.right_y_q8);
    row_y_ = quotient(l * region_.right_x_q8);
  }
  std::int32_t x(int j) const { return column_x_[j] + row_x_; }
  std::int32_t y(int j) const { return column_y_[j] + row_y_; }
  const std::int32_t* columns_x() const { return column_x_.data(); }
  const std::int32_t* columns_y() const { return column_y_.data(); }
  std::int32_t row_x() const { return row_x_; }
  std::int32_t row_y() const { return row_y_; }

 private:
  /// a / side, rounded down.
  std::int32_t quotient(std::int64_t a) const { return static_cast<std::int32_t>(a / side_ - (a % side_ < 0)); }

  TurnedSquare region_;
  int side_;
  std::int32_t row_x_ = 0, row_y_ = 0;
  std::array<std::int32_t, kMostSide> column_x_, column_y_;
};

}  // namespace duo
