// What moves in the right picture lands where it was at the left picture's moment; the rest keeps its bits.
#include "stages/align_time/align_time.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "duoptic/synthetic.h"

namespace duo {
namespace {

constexpr Size kPictureSize{320, 240};  // cells of one pixel
constexpr int kSide = 48;               // of the square
constexpr TimeNs kFrame_ns = 33'000'000;
constexpr int kSame = 24;  // levels: a place between pixels is a mean of them

std::uint8_t hashed(int x, int y, unsigned seed) {
  unsigned h = static_cast<unsigned>(x) * 73856093U ^ static_cast<unsigned>(y) * 19349663U ^ seed * 83492791U;
  h = (h ^ (h >> 13)) * 1274126177U;
  return static_cast<std::uint8_t>(40 + (h >> 16) % 160);
}

/// Patches of 3 x 3 pixels, a square of others at (left, top).
Image<Rgb8> scene(int left, int top) {
  Image<Rgb8> out(kPictureSize);
  for (int y = 0; y < kPictureSize.height; ++y)
    for (int x = 0; x < kPictureSize.width; ++x) {
      const bool in = x >= left && y >= top && x < left + kSide && y < top + kSide;
      const std::uint8_t g = in ? hashed((x - left) / 3, (y - top) / 3, 1) : hashed(x / 3, y / 3, 2);
      out.at(y, x) = {g, g, static_cast<std::uint8_t>(in ? 200 : 90)};
    }
  return out;
}

Pair pair_of(Image<Rgb8> right, TimeNs t_ns, TimeNs skew_ns) {
  Pair pair;
  pair.left.pixels = Image<Rgb8>(right.size());
  pair.left.t_ns = t_ns;
  pair.right.t_ns = t_ns + skew_ns;
  pair.right.pixels = std::move(right);
  return pair;
}

/// Pixels that differ by more than some levels.
int differing(const Image<Rgb8>& a, const Image<Rgb8>& b, int levels) {
  int count = 0;
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x) count += std::abs(a.at(y, x).g - b.at(y, x).g) > levels;
  return count;
}

/// Of the square at (left, top) without its rim.
int off_inside(const Image<Rgb8>& found, int left, int top) {
  const Image<Rgb8> want = scene(left, top);
  int count = 0;
  for (int y = top + 4; y < top + kSide - 4; ++y)
    for (int x = left + 4; x < left + kSide - 4; ++x) count += std::abs(found.at(y, x).g - want.at(y, x).g) > kSame;
  return count;
}

// 12 to the right and 6 up in a frame, and a third of a frame late: 4 and 2 too far.
TEST(AlignTime, LandsWhereItWas) {
  ref::AlignTime align;
  EXPECT_EQ(align.right_of(pair_of(scene(100, 100), 0, kFrame_ns / 3)), nullptr);  // no picture before
  const Pair late = pair_of(scene(112, 94), kFrame_ns, kFrame_ns / 3);
  const Image<Rgb8>* found = align.right_of(late);
  ASSERT_NE(found, nullptr);
  EXPECT_GT(off_inside(late.right.pixels, 108, 96), 1000);  // of 1600
  EXPECT_LT(off_inside(*found, 108, 96), 40);
  int square = 0;  // what it covered when it was too far is ground again, which is yellow
  for (int y = 100; y < 136; ++y)
    for (int x = 157; x < 160; ++x) square += late.right.pixels.at(y, x).b > 145 && found->at(y, x).b > 145;
  EXPECT_LT(square, 36);  // of 108
}

// A third of a frame early: it goes on by 4 and 2.
TEST(AlignTime, AnEarlyPictureGoesOn) {
  ref::AlignTime align;
  align.right_of(pair_of(scene(100, 100), 0, -kFrame_ns / 3));
  const Pair early = pair_of(scene(112, 94), kFrame_ns, -kFrame_ns / 3);
  const Image<Rgb8>* found = align.right_of(early);
  ASSERT_NE(found, nullptr);
  EXPECT_GT(off_inside(early.right.pixels, 116, 92), 1000);
  EXPECT_LT(off_inside(*found, 116, 92), 40);
}

// A pair that is only remembered is as good a picture before as one that was put right.
TEST(AlignTime, RememberedPairsCount) {
  const Pair before = pair_of(scene(100, 100), 0, kFrame_ns / 3), late = pair_of(scene(112, 94), kFrame_ns, kFrame_ns / 3);
  ref::AlignTime align, remembers;
  align.right_of(before);
  remembers.remember(before);
  const Image<Rgb8>*want = align.right_of(late), *got = remembers.right_of(late);
  ASSERT_TRUE(want != nullptr && got != nullptr);
  EXPECT_EQ(differing(*want, *got, 0), 0);
  // So is one in step: cameras of unlike rates are together in one pair and apart in the next.
  remembers.remember(pair_of(scene(112, 94), 2 * kFrame_ns, 0));
  const Image<Rgb8>* next = remembers.right_of(pair_of(scene(124, 90), 3 * kFrame_ns, kFrame_ns / 3));
  ASSERT_NE(next, nullptr);
  EXPECT_LT(off_inside(*next, 121, 91), 40);  // a quarter of the way back
}

TEST(AlignTime, StillThingsKeepTheirBits) {
  ref::AlignTime align;
  align.right_of(pair_of(scene(100, 100), 0, 9'000'000));
  const Image<Rgb8>* found = align.right_of(pair_of(scene(100, 100), kFrame_ns, 9'000'000));
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(differing(*found, scene(100, 100), 0), 0);
}

TEST(AlignTime, NothingToDoOrNothingToDoItWith) {
  ref::AlignTime align;
  const auto moved = [&](TimeNs t_ns, TimeNs skew_ns, Size size = kPictureSize) {
    return align.right_of(pair_of(Image<Rgb8>(size), t_ns, skew_ns)) != nullptr;
  };
  EXPECT_FALSE(moved(0, 5'000'000));
  EXPECT_TRUE(moved(kFrame_ns, 5'000'000));
  EXPECT_FALSE(moved(2 * kFrame_ns, 0));                     // in step
  EXPECT_TRUE(moved(3 * kFrame_ns, 5'000'000));              // and kept for the next
  EXPECT_TRUE(moved(4 * kFrame_ns, -5'000'000));             // the sign may change
  EXPECT_FALSE(moved(4 * kFrame_ns, -5'000'000));            // the same again
  EXPECT_FALSE(moved(20 * kFrame_ns, 5'000'000));            // a gap
  EXPECT_FALSE(moved(21 * kFrame_ns, 5'000'000, {31, 17}));  // another size
  EXPECT_TRUE(moved(22 * kFrame_ns, 5'000'000, {31, 17}));
  EXPECT_FALSE(moved(23 * kFrame_ns, 5'000'000, {3, 1}));
  EXPECT_TRUE(moved(24 * kFrame_ns, 5'000'000, {3, 1}));
  EXPECT_FALSE(moved(25 * kFrame_ns, 900'000'000, {3, 1}));  // no pair
}

// A waving person, 16 ms late: the right picture must come clearly nearer to the one taken in time. Still things are the same
// in both, noise and all.
TEST(AlignTime, ARenderedArmComesBack) {
  SyntheticClipSetup setup{.size = {320, 240}, .seed = 1, .script = "wave"};
  auto in_time = SyntheticClip::open(setup, 2);
  setup.skew_s = 0.016;
  auto late = SyntheticClip::open(setup, 2);
  ASSERT_TRUE(in_time.has_value() && late.has_value());
  ref::AlignTime align;
  int before = 0, after = 0;
  for (int i = 17; i < 22; ++i) {
    const Pair pair = late->frame(i).pair;
    EXPECT_EQ(pair.right.t_ns - pair.left.t_ns, 16'000'000);
    const Image<Rgb8>* found = align.right_of(pair);
    if (i == 17) continue;
    ASSERT_NE(found, nullptr);
    const Image<Rgb8> want = in_time->frame(i).pair.right.pixels;
    before += differing(pair.right.pixels, want, kSame);
    after += differing(*found, want, kSame);
  }
  EXPECT_GT(before, 400);
  EXPECT_LT(after, 0.65 * before);
}

}  // namespace
}  // namespace duo
