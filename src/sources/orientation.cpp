#include "sources/orientation.h"

#include <cmath>
#include <utility>

namespace duo {
namespace {

/// Which stored pixel is shown: first the axes change places, then the stored column and row count from the other end.
struct Turn {
  bool swaps, from_right, from_bottom;
};

Turn turn_of(Orientation orientation) {
  switch (orientation) {
    case Orientation::kTopRight:
      return {false, true, false};
    case Orientation::kBottomRight:
      return {false, true, true};
    case Orientation::kBottomLeft:
      return {false, false, true};
    case Orientation::kLeftTop:
      return {true, false, false};
    case Orientation::kRightTop:
      return {true, false, true};
    case Orientation::kRightBottom:
      return {true, true, true};
    case Orientation::kLeftBottom:
      return {true, true, false};
    case Orientation::kTopLeft:
      break;
  }
  return {false, false, false};
}

}  // namespace

Orientation orientation_of_exif(unsigned value) {
  return value >= 1 && value <= 8 ? static_cast<Orientation>(value) : Orientation::kTopLeft;
}

Orientation orientation_of_matrix(const std::array<std::int32_t, 9>& matrix) {
  // A stored point (x, y) is shown at (a x + c y, b x + d y).
  const double a = matrix[0], b = matrix[1], c = matrix[3], d = matrix[4];
  const bool swaps = std::abs(b) + std::abs(c) > std::abs(a) + std::abs(d);
  if (!swaps && a == 0 && d == 0) return Orientation::kTopLeft;  // no matrix at all
  const bool from_right = swaps ? c != 0 && b < 0 : a < 0, from_bottom = swaps ? c < 0 : d < 0;
  for (unsigned i = 1; i <= 8; ++i) {
    const Turn turn = turn_of(static_cast<Orientation>(i));
    if (turn.swaps == swaps && turn.from_right == from_right && turn.from_bottom == from_bottom)
      return static_cast<Orientation>(i);
  }
  return Orientation::kTopLeft;
}

Size upright(Size stored, Orientation orientation) {
  return turn_of(orientation).swaps ? Size{stored.height, stored.width} : stored;
}

void put_upright(Image<Rgb8>& picture, Orientation orientation, Image<Rgb8>& memory) {
  if (orientation == Orientation::kTopLeft) return;
  const Turn turn = turn_of(orientation);
  const Size stored = picture.size(), shown = upright(stored, orientation);
  if (memory.size() != shown) memory = Image<Rgb8>(shown);
  for (int y = 0; y < shown.height; ++y)
    for (int x = 0; x < shown.width; ++x) {
      const int column = turn.swaps ? y : x, row = turn.swaps ? x : y;
      memory.at(y, x) =
          picture.at(turn.from_bottom ? stored.height - 1 - row : row, turn.from_right ? stored.width - 1 - column : column);
    }
  std::swap(picture, memory);
}

}  // namespace duo
