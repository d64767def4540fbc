// Bars of both pictures are told with their size; dark rooms, crooked borders and one picture's bars are not taken for them.
#include "pipeline/black_bars.h"

#include <gtest/gtest.h>

#include <functional>

namespace duo {
namespace {

/// What a pixel of both pictures shows, of the left one where `left`.
using LevelAt = std::function<int(bool left, int x, int y)>;

std::optional<std::string> told_of(const LevelAt& level) {
  Pair pair;
  for (const bool left : {true, false}) {
    Image<Rgb8>& picture = (left ? pair.left : pair.right).pixels;
    picture = Image<Rgb8>({160, 120});
    for (int y = 0; y < 120; ++y)
      for (int x = 0; x < 160; ++x) {
        const auto value = static_cast<std::uint8_t>(level(left, x, y));
        picture.at(y, x) = {value, value, value};
      }
  }
  return black_bars(pair);
}
int room(int x, int y) { return 30 + (7 * x + 11 * y) % 190; }

/// By hand: 16:9 in 160x120 is 90 rows, 15 above and 15 below; 4:3 on its side is 90 columns; crops are even.
TEST(BlackBars, AreToldWithTheirSize) {
  const std::string rows = *told_of([](bool, int x, int y) { return y < 15 || y >= 105 ? 16 : room(x, y); });
  EXPECT_NE(rows.find("15 px at the top and the bottom"), std::string::npos) << rows;
  EXPECT_NE(rows.find("crop=160:88:0:16"), std::string::npos) << rows;
  const std::string columns = *told_of([](bool, int x, int y) { return x < 35 || x >= 125 ? 0 : room(x, y); });
  EXPECT_NE(columns.find("35 px at both sides"), std::string::npos) << columns;
  EXPECT_NE(columns.find("crop=88:120:36:0"), std::string::npos) << columns;
}

TEST(BlackBars, WhatIsNone) {
  EXPECT_EQ(told_of([](bool, int x, int y) { return room(x, y); }), "");
  EXPECT_EQ(told_of([](bool, int, int) { return 0; }), std::nullopt);                              // covered
  EXPECT_EQ(told_of([](bool, int x, int y) { return y < 15 ? 16 : room(x, y); }), "");             // a dark ceiling
  EXPECT_EQ(told_of([](bool, int x, int y) { return y < 15 || y >= 90 ? 16 : room(x, y); }), "");  // and a dark floor
  EXPECT_EQ(told_of([](bool left, int x, int y) { return left && (y < 15 || y >= 105) ? 16 : room(x, y); }), "");
  EXPECT_EQ(told_of([](bool, int x, int y) { return y < 15 + x / 10 || y >= 89 + x / 10 ? 16 : room(x, y); }), "");  // crooked
  EXPECT_EQ(told_of([](bool, int x, int y) { return std::min(room(x, y), std::min(y, 119 - y)); }), "");  // dark at its border
  EXPECT_EQ(black_bars({}), std::nullopt);
}

}  // namespace
}  // namespace duo
