#include <algorithm>

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

namespace {

/// The whole part of the square root, bit by bit.
std::uint64_t whole_root(std::uint64_t v) {
  std::uint64_t root = 0;
  for (int bit = 30; bit >= 0; --bit) {
    const std::uint64_t longer = root | std::uint64_t{1} << bit;
    if (longer * longer <= v) root = longer;
  }
  return root;
}

/// Standard deviation, rounded down; below 2^31. With up to 2^23 pixels count^2 V = count squares - sum^2 is below 2^60 and
/// count^2 at most 2^46, so each step of the long division, 16 bits of the fraction, stays below 2^62.
std::uint64_t deviation_q24(const BrightnessSums& s) {
  const auto square = static_cast<std::uint64_t>(s.count * s.count);
  auto rest = static_cast<std::uint64_t>(s.squares * s.count - s.sum * s.sum);
  std::uint64_t variance_q48 = rest / square;  // below 2^14
  for (int step = 0; step < 3; ++step) {
    rest = rest % square << 16;
    variance_q48 = variance_q48 << 16 | rest / square;
  }
  return whole_root(variance_q48);
}

std::int64_t mean_q16(const BrightnessSums& s) { return ((s.sum << 16) + s.count / 2) / s.count; }

}  // namespace

std::array<std::uint8_t, 256> balance_table(const BrightnessSums& left, const BrightnessSums& right) {
  std::int64_t gain_q16 = 1 << 16, offset_q16 = 0;
  if (left.count > 0 && right.count > 0) {
    const std::uint64_t from = deviation_q24(right), to = deviation_q24(left);
    // One pixel of 2^23 that differs gives a deviation of 2^-12: the gain is below 2^19, and its products below 2^59.
    if (from > 0 && to > 0) gain_q16 = static_cast<std::int64_t>(((to << 16) + from / 2) / from);
    offset_q16 = mean_q16(left) - ((gain_q16 * mean_q16(right) + (1 << 15)) >> 16);
  }
  std::array<std::uint8_t, 256> table{};
  for (int v = 0; v < 256; ++v)
    table[static_cast<std::size_t>(v)] =
        static_cast<std::uint8_t>(std::clamp<std::int64_t>((gain_q16 * v + offset_q16 + (1 << 15)) >> 16, 0, 255));
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
