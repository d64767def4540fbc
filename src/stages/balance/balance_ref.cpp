#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "stages/balance/balance.h"

namespace duo {

BrightnessSums brightness_sums(View<const std::uint8_t> picture, View<const std::uint8_t> inside, int y_begin, int y_end) {
  BrightnessSums out;
  for (int y = y_begin; y < y_end; ++y) {
    const std::uint8_t *row = picture.row(y), *mask = inside.empty() ? nullptr : inside.row(y);
    // A row of 255^2 fits 32 bits up to 66,000 columns, far beyond any picture that the engine takes.
    std::uint32_t count = 0, sum = 0, squares = 0;
    for (int x = 0; x < picture.width(); ++x) {
      const std::uint32_t counts = mask == nullptr || mask[x] != 0, v = counts != 0 ? row[x] : 0;
      count += counts;
      sum += v;
      squares += v * v;
    }
    out.add({count, sum, squares});
  }
  return out;
}

std::array<std::uint8_t, 256> balance_table(const BrightnessSums& left, const BrightnessSums& right) {
  const auto mean = [](const BrightnessSums& s) {
    return s.count == 0 ? 0.0 : static_cast<double>(s.sum) / static_cast<double>(s.count);
  };
  // Times count^2, and exact in integers: below 2^63 for up to 2^23 pixels.
  const auto variance = [](const BrightnessSums& s) { return static_cast<double>(s.squares * s.count - s.sum * s.sum); };
  double gain = 1;
  if (left.count > 0 && right.count > 0 && variance(left) > 0 && variance(right) > 0)
    gain = std::sqrt(variance(left) / variance(right)) * static_cast<double>(right.count) / static_cast<double>(left.count);
  const double offset = left.count > 0 && right.count > 0 ? mean(left) - gain * mean(right) : 0;
  std::array<std::uint8_t, 256> table{};
  for (int v = 0; v < 256; ++v)
    table[static_cast<std::size_t>(v)] = static_cast<std::uint8_t>(std::clamp(std::floor(gain * v + offset + 0.5), 0.0, 255.0));
  return table;
}

namespace ref {

void balance(const GrayPair& pair, View<std::uint8_t> dst) {
  DUO_CHECK(pair.right.size() == dst.size());
  const int h = dst.height();
  const auto table =
      balance_table(brightness_sums(pair.left, pair.left_inside, 0, h), brightness_sums(pair.right, pair.right_inside, 0, h));
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < dst.width(); ++x) dst.at(y, x) = table[pair.right.at(y, x)];
}

}  // namespace ref
}  // namespace duo
