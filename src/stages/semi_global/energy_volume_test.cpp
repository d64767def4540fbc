#include "stages/semi_global/energy_volume.h"

#include "tests/agree.h"
#include "tests/semi_global_views.h"

namespace duo {
namespace {

Image<std::uint8_t> plain(const EnergyVolume& volume) {
  const int n = volume.max_disparity();
  Image<std::uint8_t> out({volume.size().width * n, volume.size().height});
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < volume.size().width; ++x)
      for (int d = 0; d < n; ++d) out.at(y, x * n + d) = volume.cell(y, x)[volume.lanes() - 1 - d];
  return out;
}

// The example of semi_global_test.cpp with higher steps in gray. Only gray counts; left 90 90 90, right 90 10 90,
// truncation 32. C: x = 0 (0 0), x = 1 (32 0), x = 2 (0 32). P1 = 3, P2 = 5. From the left: (0 0), (32 0), (0 + 3, 32 + 0).
// From the right: (0 32), (32 + 0, 0 + 3), then least 3: (0 + min(32 - 3, 3), 0 + 0). Down: C. S: (0 + 3 + 0, 0) = (3 0), (32 +
// 32 + 32, 0 + 3 + 0) = (96 3), (3 + 0 + 0, 32 + 32 + 32) = (3 96). E: x = 0: (3 + 1, 0); x = 1: s = 93 held to 55: (25 + 55 +
// 27, 0); x = 2: (0, 25 + 55 + 27).
TEST(EnergyVolume, HandWorked) {
  const auto left = test::image<std::uint8_t>({{90, 90, 90}}), right = test::image<std::uint8_t>({{90, 10, 90}});
  test::Views views(left, right, {}, 2);
  views.keep_gray_alone();
  SemiGlobalParams params;
  params.census_truncation = 0;
  params.truncation = 32;
  params.p1 = 3;
  params.p2 = params.p2_least = 5;
  EnergyVolume got(left.size(), 2);
  ref::energy_volume(views.in(2, params), got);
  test::expect_same<std::uint8_t>(test::image<std::uint8_t>({{4, 0, 107, 0, 0, 107}}), plain(got), "E");
}

TEST(EnergyVolume, SimdAgrees) {
  std::mt19937 rng(32);
  const std::pair<Size, int> cases[] = {{{70, 13}, 40}, {{33, 5}, 70},  {{1, 1}, 1},
                                        {{40, 4}, 129}, {{30, 3}, 256}, {{9, 6}, 64}};
  for (const auto& each : cases)
    for (const bool masked : {false, true}) {
      const Size size = each.first;
      const int max_disparity = each.second;
      Image<std::uint8_t> left(size), right(size), inside(size);
      test::fill(left.view(), test::Fill::kRandom, rng);
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
          right.at(y, x) = rng() % 4 ? left.at(y, std::min(size.width - 1, x + 3)) : static_cast<std::uint8_t>(rng());
          inside.at(y, x) = rng() % 11 ? 255 : 0;
        }
      const test::Views views(left, right, masked ? View<const std::uint8_t>(inside) : View<const std::uint8_t>{},
                              max_disparity);
      const SemiGlobal in = views.in(max_disparity, {});
      EnergyVolume want(size, max_disparity);
      ref::energy_volume(in, want);
      test::each_target([&](const std::string& target) {
        for (const int threads : {1, 2, 3}) {
          Pool pool(threads);
          simd::EnergyVolumeScratch scratch(size, max_disparity, threads);
          EnergyVolume got(size, max_disparity);
          for (int frame = 0; frame < 2; ++frame) simd::energy_volume(pool, in, scratch, got);
          test::expect_same<std::uint8_t>(
              plain(want), plain(got),
              "energy_volume " + target + " threads " + std::to_string(threads) + " N " + std::to_string(max_disparity));
        }
      });
      if (HasFailure()) return;
    }
}

}  // namespace
}  // namespace duo
