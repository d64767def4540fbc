#include "stages/slanted_planes/slanted_planes.h"

#include <cmath>

#include "stages/slanted_planes/plane_fit.h"
#include "tests/agree.h"

namespace duo {
namespace {

constexpr int kOne = Plane::kOne;

EnergyVolume energies_of(Size size, int max_disparity, auto&& energy) {
  EnergyVolume out(size, max_disparity);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      for (int d = 0; d < max_disparity; ++d) out.cell(y, x)[out.lanes() - 1 - d] = static_cast<std::uint8_t>(energy(y, x, d));
  return out;
}

TEST(SlantedPlanes, WeightsFollowTheirFormula) {
  for (int i = 0; i < 16; ++i)
    EXPECT_EQ(SlantedPlanes::kWeights[static_cast<std::size_t>(i)],
              std::max(1L, std::lround(255 * std::exp(-(4 * i + 1.5) / 10))))
        << i;
}

// By hand, of pixel 0 in a row of five: taps at 0, 2 and 4, weights 219, 147 (a colour step of 4) and 0 (one of 64). Energies
// 10 d + x. The plane 1.5 + 0.25 i has 1.5 and 2.0 there: 16 * 15 = 240 and 16 * 22 = 352.
TEST(SlantedPlanes, EnergyByHand) {
  const EnergyVolume energies = energies_of({5, 1}, 4, [](int, int x, int d) { return 10 * d + x; });
  Image<Rgb8> guide({5, 1});
  guide.at(0, 2) = {1, 2, 1};
  guide.at(0, 4) = {64, 0, 0};
  const SlantedPlanes in{energies, guide};
  EXPECT_EQ(ref::plane_energy(in, 0, 0, {3 * kOne / 2, kOne / 4, 0}), 219 * 240 + 147 * 352);
  // Held to the range, 0 .. 3, at both ends; slopes along y find no row.
  EXPECT_EQ(ref::plane_energy(in, 0, 0, {3 * kOne, kOne, kOne}), 16 * (219 * 30 + 147 * 32));
  EXPECT_EQ(ref::plane_energy(in, 0, 0, {0, -kOne, 0}), 16 * 147 * 2);
}

// By hand: 81 taps of equal weight on a slope of 4/16 px per px. The spread of -8, -6 .. 8 is 240 / 9, so that the slope is
// drawn to 4 (240 / 9) / (240 / 9 + 2) = 3.7209 sixteenths, 952.6 in 1/4096.
TEST(SlantedPlanes, FitByHand) {
  Image<std::uint16_t> d_q4({17, 17});
  Image<Rgb8> guide(d_q4.size());
  for (int y = 0; y < 17; ++y)
    for (int x = 0; x < 17; ++x) d_q4.at(y, x) = static_cast<std::uint16_t>(32 + 4 * x);
  PlaneMap planes(d_q4.size());
  Pool two(2);
  simd::fit_planes(two, {guide, d_q4, 16}, planes);
  EXPECT_EQ(planes.at(8, 8), (Plane{4 * kOne, 953, 0}));
  d_q4.at(1, 8) = 200;  // at odd distances: no taps
  d_q4.at(8, 1) = 200;
  EXPECT_EQ(fitted_plane({guide, d_q4, 16}, 8, 8), (Plane{4 * kOne, 953, 0}));
  d_q4.at(3, 3) = Disparity::kNone;
  EXPECT_EQ(fitted_plane({guide, d_q4, 16}, 3, 3), Plane{});
}

// A surface that rises by a quarter of a pixel per column is found from a map of whole numbers that is wrong in places.
TEST(SlantedPlanes, FindsASlope) {
  const Size size{60, 20};
  const EnergyVolume energies = energies_of(size, 24, [](int, int x, int d) {
    const int off = 4 * d - (x + 12);  // in quarters of a pixel
    return std::min(85, off * off);
  });
  Image<Rgb8> guide(size);
  Image<std::uint16_t> d_q4(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) d_q4.at(y, x) = static_cast<std::uint16_t>((x + y) % 7 == 0 ? 0 : (x + 14) / 4 * 16);
  PlaneMap planes(size);
  ref::fit_planes({guide, d_q4, 24}, planes);
  ref::slanted_planes({energies, guide}, planes);
  double sum = 0;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const int off = std::abs(planes.at(y, x).d - (x + 12) * kOne / 4);
      EXPECT_LE(off, kOne) << y << " " << x;
      sum += off;
    }
  EXPECT_LT(sum / (size.width * size.height), 0.25 * kOne);
}

TEST(SlantedPlanes, SimdAgrees) {
  std::mt19937 rng(33);
  const std::pair<Size, int> cases[] = {{{70, 9}, 40}, {{1, 1}, 1}, {{17, 30}, 64}, {{131, 5}, 129}};
  for (const auto& each : cases) {
    const Size size = each.first;
    const int max_disparity = each.second;
    const EnergyVolume energies = energies_of(size, max_disparity, [&](int, int, int) { return rng() % 86; });
    Image<Rgb8> guide(size);
    PlaneMap want(size);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const auto v = static_cast<std::uint8_t>(rng() % 20);
        guide.at(y, x) = rng() % 6 != 0 ? Rgb8{v, 90, v} : Rgb8{255, 0, v};
        const auto slope = [&] { return static_cast<int>(rng() % (4 * kOne)) - 2 * kOne; };
        want.set(y, x, {static_cast<int>(rng() % static_cast<unsigned>(max_disparity)) * kOne, slope(), slope()});
      }
    const auto start = [&](const PlaneMap& from) {
      PlaneMap out(size);
      out.d = from.d.clone(), out.dx = from.dx.clone(), out.dy = from.dy.clone();
      return out;
    };
    const PlaneMap first = start(want);
    ref::slanted_planes({energies, guide}, want);
    test::each_target([&](const std::string& target) {
      for (const int threads : {1, 2}) {
        Pool pool(threads);
        simd::SlantedPlanesScratch scratch(size);
        PlaneMap got = start(first);
        simd::slanted_planes(pool, {energies, guide}, scratch, got);
        const std::string what = "slanted_planes " + target + " threads " + std::to_string(threads);
        test::expect_same<std::int32_t>(want.d, got.d, what + " d");
        test::expect_same<std::int32_t>(want.dx, got.dx, what + " dx");
        test::expect_same<std::int32_t>(want.dy, got.dy, what + " dy");
      }
    });
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace duo
