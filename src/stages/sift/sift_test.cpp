#include "stages/sift/sift.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "stages/sift/functions.h"
#include "tests/agree.h"
#include "tests/allocations.h"

namespace duo {
namespace {

using Texture = Image<std::uint8_t>;
constexpr double kPi = 3.14159265358979323846;

Window whole(const Texture& picture) { return Window::all(picture.size()); }

SiftPoints found_by_ref(const Texture& picture, const Window& window, const SiftParams& params = {}, int capacity = 4000) {
  SiftPoints points(capacity);
  ref::sift(picture, window, params, points);
  return points;
}

/// background + blobs of sigma `sigma_px` + a slope along `slope_rad`.
struct Blob {
  double x, y, sigma_px, height;
};
Texture draw(Size size, const std::vector<Blob>& blobs, double slope = 0, double slope_rad = 0) {
  Texture out(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      double v = 110 + slope * ((x - size.width / 2) * std::cos(slope_rad) + (y - size.height / 2) * std::sin(slope_rad));
      for (const Blob& b : blobs)
        v += b.height * std::exp(-(std::pow(x - b.x, 2) + std::pow(y - b.y, 2)) / (2 * b.sigma_px * b.sigma_px));
      out.at(y, x) = static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0, 255.0)));
    }
  return out;
}

/// Random blobs of many sizes: points in every octave.
Texture blobs(Size size, unsigned seed) {
  std::mt19937 rng(seed);
  const auto uniform = [&](double low, double high) { return low + (high - low) * (rng() % 10007) / 10007.0; };
  std::vector<Blob> list;
  for (int i = 0; i < size.width * size.height / 60; ++i)
    list.push_back({uniform(0, size.width), uniform(0, size.height), std::pow(2, uniform(0, 3)), uniform(-60, 60)});
  return draw(size, list);
}

const SiftPoint* nearest(const SiftPoints& points, double x, double y) {
  const SiftPoint* best = nullptr;
  const auto distance = [&](const SiftPoint& p) { return std::hypot(p.x_px - x, p.y_px - y); };
  for (int i = 0; i < points.count; ++i)
    if (best == nullptr || distance(points[i]) < distance(*best)) best = &points[i];
  return best;
}

TEST(SiftFunctions, AreExact) {
  for (double x = -12; x < 2; x += 0.37) EXPECT_NEAR(sift::exponential(x) / std::exp(x), 1, 1e-8) << x;
  for (double t = 0; t <= 1; t += 0.01) {
    double cos, sin;
    sift::cos_sin(t, cos, sin);
    EXPECT_NEAR(cos, std::cos(2 * kPi * t), 1e-7) << t;
    EXPECT_NEAR(sin, std::sin(2 * kPi * t), 1e-7) << t;
  }
  float row[9];
  sift::gaussian_row(0.02, -3.5, 4096, 9, row);
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(row[i], 4096 * std::exp(-0.02 * (i - 3.5) * (i - 3.5)), 1e-2) << i;
}

// By calculation: a blob of sigma s, blurred to sqrt(s^2 + u - 1/4), u = scale^2 (the picture is taken as blurred by 1/2), has
// the height s^2 / (s^2 + u - 1/4) at its centre. The difference to the level a factor k = 2^(1/3) above is greatest at u =
// (s^2 - 1/4) / k.
TEST(Sift, FindsABlobAtItsPlaceAndScale) {
  for (const double sigma : {2.5, 4.0, 6.3, 9.0})
    for (const double height : {90.0, -90.0}) {
      const double x = 79.3, y = 82.6;
      const auto picture = draw({160, 160}, {{x, y, sigma, height}});
      const auto points = found_by_ref(picture, whole(picture));
      const SiftPoint* p = nearest(points, x, y);
      ASSERT_NE(p, nullptr) << sigma;
      EXPECT_NEAR(p->x_px, x, 0.1) << sigma;
      EXPECT_NEAR(p->y_px, y, 0.1) << sigma;
      const double want = std::sqrt((sigma * sigma - 0.25) / std::cbrt(2));
      EXPECT_NEAR(p->scale_px / want, 1, 0.05) << sigma;
    }
}

// The blob's own gradients point everywhere alike; what the slope adds decides, to half a direction's width.
TEST(Sift, TurnsAlongTheSlope) {
  for (int degrees = 0; degrees < 360; degrees += 25) {
    const auto picture = draw({56, 56}, {{28, 28, 4, 35}}, 2.5, degrees * kPi / 180);
    const auto points = found_by_ref(picture, whole(picture));
    const SiftPoint* p = nearest(points, 28, 28);
    ASSERT_NE(p, nullptr) << degrees;
    EXPECT_LT(std::hypot(p->x_px - 28, p->y_px - 28), 0.1) << degrees;
    EXPECT_NEAR(std::remainder(p->angle_rad - degrees * kPi / 180, 2 * kPi), 0, 5 * kPi / 180) << degrees;
  }
}

// A side of 16 n + 1 px: the grid of every octave turns into itself, so every point must come back turned.
TEST(Sift, TurnsWithThePicture) {
  const auto picture = blobs({193, 193}, 5);
  Texture turned(picture.size());
  for (int y = 0; y < 193; ++y)
    for (int x = 0; x < 193; ++x) turned.at(x, 192 - y) = picture.at(y, x);
  const auto points = found_by_ref(picture, whole(picture)), after = found_by_ref(turned, whole(turned));
  ASSERT_GT(points.count, 100);
  EXPECT_EQ(points.count, after.count);
  const auto came_back = [&](int i) {
    for (int k = 0; k < after.count; ++k) {
      const SiftPoint &a = points[i], &b = after[k];
      if (std::hypot(192 - a.y_px - b.x_px, a.x_px - b.y_px) > 0.02 || std::abs(a.scale_px / b.scale_px - 1) > 0.01 ||
          std::abs(std::remainder(b.angle_rad - a.angle_rad - kPi / 2, 2 * kPi)) > 0.01)
        continue;
      int worst = 0;
      for (int d = 0; d < SiftPoints::kDescriptor; ++d)
        worst = std::max(worst, std::abs(points.descriptors.at(i, d) - after.descriptors.at(k, d)));
      EXPECT_LE(worst, 3) << i;
      return true;
    }
    return false;
  };
  int same = 0;
  for (int i = 0; i < points.count; ++i) same += came_back(i);
  EXPECT_GE(same, points.count - 1);
}

TEST(Sift, DescriptorHasItsLength) {
  const auto picture = blobs({100, 80}, 8);
  const auto points = found_by_ref(picture, whole(picture));
  ASSERT_GT(points.count, 10);
  for (int i = 0; i < points.count; ++i) {
    double squares = 0;
    for (int d = 0; d < SiftPoints::kDescriptor; ++d) squares += std::pow(points.descriptors.at(i, d), 2);
    EXPECT_NEAR(std::sqrt(squares), 512, 8) << i;
  }
}

TEST(Sift, NothingWhereNothingIs) {
  EXPECT_EQ(found_by_ref(test::constant<std::uint8_t>({90, 70}, 128), {0, 0, 90, 70}).count, 0);
  const auto slope = draw({90, 70}, {}, 0.9, 0.4);
  EXPECT_EQ(found_by_ref(slope, whole(slope)).count, 0);
}

TEST(Sift, CountsWhatFindsNoRoom) {
  const auto picture = blobs({128, 96}, 3);
  const auto all = found_by_ref(picture, whole(picture)), few = found_by_ref(picture, whole(picture), {}, 7);
  EXPECT_EQ(all.overflow, 0);
  ASSERT_GT(all.count, 7);
  EXPECT_EQ(few.count, 7);
  EXPECT_GT(few.overflow, 0);
  EXPECT_LE(few.count + few.overflow, all.count);
  for (int i = 0; i < few.count; ++i) EXPECT_EQ(few[i], all[i]) << i;
  for (int i = 1; i < all.count; ++i) EXPECT_LE(all[i - 1].octave, all[i].octave) << i;
}

// With a margin that reaches over the whole picture the window only chooses; with the usual one fine octaves hardly change.
TEST(Sift, WindowSeesBeyondItsBorder) {
  const auto picture = blobs({256, 256}, 4);
  const Window window = {61, 83, 101, 90};
  const auto inside = [&](const SiftPoint& p) { return p.x_px >= 61 && p.y_px >= 83 && p.x_px < 61 + 101 && p.y_px < 83 + 90; };
  const auto all = found_by_ref(picture, whole(picture));
  SiftParams wide;
  wide.margin_px = 256;
  const auto exact = found_by_ref(picture, window, wide), usual = found_by_ref(picture, window);
  std::vector<int> chosen;
  for (int i = 0; i < all.count; ++i)
    if (inside(all[i])) chosen.push_back(i);
  ASSERT_EQ(static_cast<int>(chosen.size()), exact.count);
  ASSERT_GT(exact.count, 30);
  int fine = 0, kept = 0;
  for (int i = 0; i < exact.count; ++i) {
    const int k = chosen[static_cast<std::size_t>(i)];
    EXPECT_EQ(exact[i], all[k]);
    EXPECT_EQ(std::memcmp(exact.descriptors.row(i), all.descriptors.row(k), SiftPoints::kDescriptor), 0);
    if (exact[i].octave > 0) continue;
    ++fine;
    const SiftPoint* p = nearest(usual, exact[i].x_px, exact[i].y_px);
    kept += std::hypot(p->x_px - exact[i].x_px, p->y_px - exact[i].y_px) < 0.02;
  }
  EXPECT_EQ(kept, fine);
  for (int i = 0; i < usual.count; ++i) EXPECT_TRUE(inside(usual[i])) << i;
}

void expect_same_points(const SiftPoints& want, const SiftPoints& got, const std::string& what) {
  ASSERT_EQ(want.count, got.count) << what;
  EXPECT_EQ(want.overflow, got.overflow) << what;
  for (int i = 0; i < want.count; ++i) {
    const SiftPoint &a = want[i], &b = got[i];
    ASSERT_TRUE(a == b) << what << " point " << i << ": want " << a.x_px << " " << a.y_px << " scale " << a.scale_px
                        << " angle " << a.angle_rad << ", got " << b.x_px << " " << b.y_px << " scale " << b.scale_px
                        << " angle " << b.angle_rad;
    for (int d = 0; d < SiftPoints::kDescriptor; ++d)
      ASSERT_EQ(+want.descriptors.at(i, d), +got.descriptors.at(i, d)) << what << " point " << i << " descriptor " << d;
  }
}

TEST(Sift, SimdAgrees) {
  std::mt19937 rng(11);
  Pool one(1), two(2), three(3);
  const SiftParams params;
  std::vector<Texture> pictures;
  pictures.push_back(blobs({150, 131}, 6));
  for (const test::Fill how : test::kFills) {
    pictures.emplace_back(Size{150, 131});
    test::fill(pictures.back().view(), how, rng);
  }
  const Window windows[] = {{0, 0, 150, 131}, {149, 130, 1, 1},   {0, 0, 11, 12},  {70, 60, 13, 12},  {40, 30, 31, 33},
                            {86, 0, 64, 65},  {19, 100, 131, 31}, {3, 5, 17, 126}, {-20, 90, 90, 60}, {150, 0, 20, 20}};
  SiftScratch scratch({150, 131}, 900, params);
  for (std::size_t k = 0; k < pictures.size(); ++k)
    for (const Window& window : windows) {
      const auto want = found_by_ref(pictures[k], window, params, 900);
      test::each_target([&](const std::string& target) {
        for (Pool* pool : {&one, &two, &three}) {
          SiftPoints got(900);
          simd::sift(*pool, pictures[k], window, params, scratch, got);
          expect_same_points(want, got,
                             "sift simd " + target + " threads " + std::to_string(pool->threads()) + " picture " +
                                 std::to_string(k) + " window " + std::to_string(window.width) + "x" +
                                 std::to_string(window.height));
        }
      });
      if (HasFatalFailure()) return;
    }
}

// Wider than a chunk of the blur, narrower than an octave.
TEST(Sift, SimdAgreesOverChunks) {
  Pool two(2);
  for (const Size size : {Size{511, 20}, Size{513, 24}, Size{530, 40}, Size{5, 40}, Size{64, 3}, Size{1, 1}}) {
    const auto picture = blobs(size, 2);
    const auto want = found_by_ref(picture, whole(picture));
    SiftScratch scratch(size, 4000);
    test::each_target([&](const std::string& target) {
      SiftPoints got(4000);
      simd::sift(two, picture, whole(picture), {}, scratch, got);
      expect_same_points(want, got, "sift simd " + target + " " + std::to_string(size.width));
    });
  }
}

TEST(Sift, AllocatesNothing) {
  const auto picture = blobs({150, 131}, 6);
  Pool two(2);
  SiftScratch scratch(picture.size(), 900);
  SiftPoints points(900);
  simd::sift(two, picture, whole(picture), {}, scratch, points);
  const long before = test::allocations;
  simd::sift(two, picture, {20, 20, 90, 80}, {}, scratch, points);
  EXPECT_EQ(test::allocations - before, 0);
  EXPECT_GT(points.count, 0);
}

}  // namespace
}  // namespace duo
