#include "stages/fill_regions/fill_regions.h"

#include "stages/fill/fill.h"
#include "tests/agree.h"

namespace duo {
namespace {

using test::kNone;

/// Points of d_q4 = 100 + 3 x + 2 y; every `wrong`-th is 200 above.
std::vector<PlanePoint> points(int wrong) {
  std::vector<PlanePoint> out;
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 20; ++x) {
      const bool off = wrong > 0 && out.size() % static_cast<std::size_t>(wrong) == 0;
      out.push_back({static_cast<std::uint16_t>(y), static_cast<std::uint16_t>(x),
                     static_cast<std::uint16_t>(100 + 3 * x + 2 * y + (off ? 200 + 7 * y : 0))});
    }
  return out;
}

TEST(RegionPlane, HandWorked) {
  for (const int wrong : {0, 5, 3}) {
    RegionPlane plane;
    ASSERT_TRUE(region_plane(points(wrong), plane)) << wrong;
    EXPECT_EQ(plane.along_x_q16, 3 << 16) << wrong;
    EXPECT_EQ(plane.along_y_q16, 2 << 16) << wrong;
    EXPECT_EQ(plane.d_q4(0, 0), 100) << wrong;
    EXPECT_EQ(plane.d_q4(40, 90), 100 + 270 + 80) << wrong;
  }
  RegionPlane plane;
  const auto all = points(0);
  EXPECT_FALSE(region_plane(std::span(all).first(19), plane)) << "too few, and on one line";
  std::vector<PlanePoint> scattered = all;
  for (std::size_t i = 0; i < scattered.size(); ++i) scattered[i].d_q4 = static_cast<std::uint16_t>(200 * (i * 7 % 13));
  EXPECT_FALSE(region_plane(scattered, plane)) << "no half of them agrees";
}

// Points as they are measured, up to 3/4 px off: through three of them the slope is wrong by far more than through all.
TEST(RegionPlane, ManyPointsTellTheSlope) {
  std::vector<PlanePoint> measured = points(0);
  std::mt19937 rng(3);
  for (PlanePoint& p : measured) p.d_q4 = static_cast<std::uint16_t>(p.d_q4 + rng() % 25 - 12);
  RegionPlane plane;
  ASSERT_TRUE(region_plane(measured, plane));
  EXPECT_NEAR(plane.along_x_q16 / 65536.0, 3, 0.12);
  EXPECT_NEAR(plane.along_y_q16 / 65536.0, 2, 0.2);
}

// To least squares a step of 1/16 px amid 20 columns is a slope of 0.075/16 px per column: half a pixel 100 columns beyond
// them.
TEST(RegionPlane, AConstantIsPreferredWhereItSaysAsMuch) {
  std::vector<PlanePoint> wall = points(0);
  for (PlanePoint& p : wall) p.d_q4 = static_cast<std::uint16_t>(p.x < 10 ? 100 : 101);
  RegionPlane plane;
  ASSERT_TRUE(region_plane(wall, plane));
  EXPECT_EQ(plane.along_x_q16, 0);
  EXPECT_EQ(plane.along_y_q16, 0);
  EXPECT_NEAR(plane.d_q4(5, 200), 100, 1);
}

/// A flat wall of one gray value with texture around it; disparities of a slanted plane at its left third, holes in the rest.
struct Wall {
  static constexpr Size kSize{60, 40};
  Image<std::uint8_t> gray{kSize}, origin{kSize};
  Image<std::uint16_t> d_q4{kSize};
  static bool inside(int y, int x) { return x >= 10 && x < 50 && y >= 8 && y < 32; }
  static int plane(int y, int x) { return 300 + 2 * x - y; }
  explicit Wall(int measured_to = 30) {
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        gray.at(y, x) = inside(y, x) ? 120 : static_cast<std::uint8_t>((x + y) % 2 == 0 ? 20 : 200);
        const int d = inside(y, x) ? plane(y, x) : 700;
        d_q4.at(y, x) = inside(y, x) && x >= measured_to ? kNone : static_cast<std::uint16_t>(d);
      }
    ref::mark_measured(d_q4, origin);
  }
};

// By hand: pixels of the rim are not flat, so the region is 38 x 22 = 836 pixels at (9, 11); inner points have 8 columns and 2
// rows of it around them. Its holes take the plane, the rim's holes stay, and no measured pixel changes.
TEST(FillRegions, HandWorked) {
  Wall wall;
  const auto before = wall.d_q4.clone();
  ref::fill_regions({wall.gray, 64}, wall.d_q4, wall.origin);
  for (int y = 0; y < Wall::kSize.height; ++y)
    for (int x = 0; x < Wall::kSize.width; ++x) {
      const bool region = x >= 11 && x < 49 && y >= 9 && y < 31, filled = region && x >= 30;
      EXPECT_EQ(wall.d_q4.at(y, x), filled ? Wall::plane(y, x) : before.at(y, x)) << y << " " << x;
      EXPECT_EQ(wall.origin.at(y, x), filled ? 2 : before.at(y, x) == kNone ? 0 : 1) << y << " " << x;
    }
}

TEST(FillRegions, LeavesWhatItCannotKnow) {
  const auto unchanged = [](Wall& wall, int max_disparity, const char* why) {
    const auto before = wall.d_q4.clone();
    ref::fill_regions({wall.gray, max_disparity}, wall.d_q4, wall.origin);
    test::expect_same<std::uint16_t>(before, wall.d_q4, why);
  };
  Wall few(46);  // 3 of 38 columns are holes: less than a tenth
  unchanged(few, 64, "few holes");
  Wall none(19);  // columns 11 .. 18 are measured, and none of them has 8 columns to its left
  unchanged(none, 64, "no inner points");
  Wall beyond;  // the plane is above 16 * 18 everywhere
  unchanged(beyond, 19, "beyond the range");
  Wall torn;
  for (int y = 0; y < Wall::kSize.height; ++y)
    for (int x = 11; x < 30; ++x) torn.d_q4.at(y, x) = static_cast<std::uint16_t>(100 * ((3 * x + 5 * y) % 11));
  unchanged(torn, 80, "points that do not agree");
  Wall cut;  // two steps of 3 levels leave no region of 400 pixels
  for (int y = 0; y < Wall::kSize.height; ++y)
    for (int x = 10; x < 50; ++x) cut.gray.at(y, x) = static_cast<std::uint8_t>(120 + (x >= 23 ? 3 : 0) + (x >= 36 ? 3 : 0));
  unchanged(cut, 64, "small regions");
}

TEST(FillRegions, SimdAgrees) {
  std::mt19937 rng(8);
  Pool one(1), three(3);
  std::vector<Size> sizes = test::awkward_sizes();
  sizes.insert(sizes.end(), {{60, 40}, {255, 40}, {256, 33}, {257, 70}, {600, 50}});
  int filled = 0;
  for (const Size size : sizes)
    for (const unsigned texture : {1u, 2u, 40u}) {
      Image<std::uint8_t> gray(size), origin(size), want_origin(size), got_origin(size);
      Image<std::uint16_t> d(size);
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
          const unsigned block = static_cast<unsigned>(y / 37 + x / 53);
          gray.at(y, x) = static_cast<std::uint8_t>(60 + 20 * (block % 5) + (rng() % 40 == 0 ? rng() % texture : 0));
          d.at(y, x) =
              rng() % 3 == 0 ? kNone : static_cast<std::uint16_t>(300 + x * static_cast<int>(block % 4) - y + rng() % 5);
        }
      ref::mark_measured(d, origin);
      auto want = d.clone();
      ref::mark_measured(d, want_origin);
      ref::fill_regions({gray, 64}, want, want_origin);
      simd::FillRegionsScratch scratch(size);
      for (Pool* pool : {&one, &three})
        for (int frame = 0; frame < 2; ++frame) {  // the second must not see anything of the first
          auto got = d.clone();
          ref::mark_measured(d, got_origin);
          simd::fill_regions(*pool, {gray, 64}, scratch, got, got_origin);
          test::expect_same<std::uint16_t>(want, got, "fill_regions simd");
          test::expect_same<std::uint8_t>(want_origin, got_origin, "fill_regions origin simd");
        }
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) filled += want_origin.at(y, x) == 2;
      if (HasFailure()) return;
    }
  EXPECT_GT(filled, 1000);
}

}  // namespace
}  // namespace duo
