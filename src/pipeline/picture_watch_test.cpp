// What is told of pictures: of files at their end, live only what is so now.
#include "pipeline/picture_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace duo {
namespace {

constexpr Size kRoomSize = {160, 96};

/// A bar that moves and rests at no regular times, between black bars of a sixth each.
Image<Rgb8> room_at(int i) {
  const double place = 60 + 25 * std::sin(0.11 * i) * std::sin(0.043 * i + 1) + 25 * std::sin(0.017 * i * i * 0.1);
  Image<Rgb8> out(kRoomSize);
  for (int y = 16; y < 80; ++y)
    for (int x = 0; x < out.width(); ++x) {
      const auto level = static_cast<std::uint8_t>(std::abs(x - place) < 20 ? 220 : 70);
      out.at(y, x) = {level, level, level};
    }
  return out;
}

/// The right video began `later` pictures of 40 ms after the left one.
PictureWatch after(int pairs, int later) {
  PictureWatch watch;
  for (int i = 0; i < pairs; ++i) {
    Pair pair;
    pair.left.pixels = room_at(i);
    pair.right.pixels = room_at(i + later);
    pair.left.t_ns = i * TimeNs{40'000'000};
    watch.see(pair, false);
  }
  return watch;
}

TEST(PictureWatch, TellsAllThatIsWrongWithFiles) {
  const std::string both = after(100, 12).warning(false);
  EXPECT_EQ(both.find("both pictures have black bars of 16 px"), 0u) << both;
  EXPECT_NE(both.find("; the right video seems to have begun 480 ms later"), std::string::npos) << both;
  const std::string bars = after(100, 0).warning(false);
  EXPECT_NE(bars, "");
  EXPECT_EQ(bars.find("begun"), std::string::npos) << bars;
  EXPECT_EQ(after(100, 12).warning(true), "");
  EXPECT_EQ(PictureWatch().warning(false), "");
}

TEST(PictureWatch, BarsAreThoseOfAllPairsThatShowSomething) {
  const auto pair_of = [](const Image<Rgb8>& picture) {
    Pair pair;
    pair.left.pixels = picture.clone();
    pair.right.pixels = picture.clone();
    return pair;
  };
  Image<Rgb8> gray(kRoomSize);
  for (int y = 0; y < gray.height(); ++y) std::fill_n(gray.row(y), gray.width(), Rgb8{90, 90, 90});
  const Pair dark = pair_of(Image<Rgb8>(kRoomSize)), barred = pair_of(room_at(0)), whole = pair_of(gray);
  PictureWatch fades_in, title;
  for (const Pair* pair : {&dark, &barred, &barred, &barred}) fades_in.see(*pair, false);
  EXPECT_NE(fades_in.warning(false).find("black bars"), std::string::npos);
  for (const Pair* pair : {&barred, &whole, &whole, &barred}) title.see(*pair, false);
  EXPECT_EQ(title.warning(false), "");
}

}  // namespace
}  // namespace duo
