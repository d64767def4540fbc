#include "matchers/fine/fine.h"

#include <algorithm>
#include <cstdlib>

namespace duo {
namespace {

template <class T>
View<const T> mirrored(View<const T> from, Image<T>& into) {
  for (int y = 0; y < from.height(); ++y) std::reverse_copy(from.row(y), from.row(y) + from.width(), into.row(y));
  return from.empty() ? View<const T>{} : into.view();
}

}  // namespace

MirroredPair::MirroredPair(Size size, bool masked)
    : left_(size),
      right_(size),
      left_inside_(masked ? size : Size{}),
      right_inside_(masked ? size : Size{}),
      left_color_(size),
      right_color_(size) {}

GrayPair MirroredPair::of(const GrayPair& pair) {
  GrayPair out;
  out.left = mirrored(pair.right, left_);
  out.right = mirrored(pair.left, right_);
  out.left_inside = mirrored(pair.right_inside, left_inside_);
  out.right_inside = mirrored(pair.left_inside, right_inside_);
  out.left_color = mirrored(pair.right_color, left_color_);
  out.right_color = mirrored(pair.left_color, right_color_);
  out.coding_noise_q4 = pair.coding_noise_q4;
  return out;
}

FineMaps::FineMaps(Size size) : unfilled(size), median(size), holes(size), left(size), mirrored(size) {
  whole.d_q4 = Image<std::uint16_t>(size);
  whole.origin = Image<std::uint8_t>(size);
}

void check_planes(const GrayPair& pair, const PlaneMap& left, const PlaneMap& mirrored, int tolerance,
                  View<std::uint16_t> d_q4) {
  constexpr int kHalf = Plane::kOne / 2, kPerSixteenth = Plane::kOne / 16;
  const int w = d_q4.width();
  for (int y = 0; y < d_q4.height(); ++y)
    for (int x = 0; x < w; ++x) {
      const int d = left.d.at(y, x), other = x - ((d + kHalf) >> Plane::kBits);
      const bool inside =
          other >= 0 && (!pair.masked() || (pair.left_inside.at(y, x) != 0 && pair.right_inside.at(y, other) != 0));
      const bool agrees = inside && std::abs(mirrored.d.at(y, w - 1 - other) - d) <= tolerance * Plane::kOne;
      d_q4.at(y, x) = agrees ? static_cast<std::uint16_t>((d + kPerSixteenth / 2) / kPerSixteenth) : Disparity::kNone;
    }
}

void keep_margin(View<const std::uint16_t> lines, View<std::uint16_t> voted) {
  for (int y = 0; y < lines.height(); ++y)
    for (int x = 0; x < lines.width(); ++x)
      if (16 * x < lines.at(y, x)) voted.at(y, x) = lines.at(y, x);
}

}  // namespace duo
