#include "stages/depth/depth.h"

#include "tests/agree.h"

namespace duo {
namespace {

// By hand, f = 500 px, b = 120 mm: f b = 60000. d = 40 px -> 1500 mm; d = 16.5 px -> 3636.36 -> 3636; d = 1/16 px -> 960 m: none.
TEST(Depth, HandWorked) {
  const auto d = test::image<std::uint16_t>({{40 * 16, 264, 0, Disparity::kNone, 1}});
  Image<std::uint16_t> mm(d.size());
  ref::depth(d, 60000.0F, mm);
  const int want[5] = {1500, 3636, 0, 0, 0};
  for (int x = 0; x < 5; ++x) EXPECT_EQ(mm.at(0, x), want[x]) << x;
}

TEST(Depth, SimdAgrees) {
  for (const float focal_baseline : {60000.0F, 70236.7F, 123.4F, 1.0e7F})
    test::agree<std::uint16_t, std::uint16_t>(
        "depth", [&](auto src, auto dst) { ref::depth(src, focal_baseline, dst); },
        [&](Pool& pool, auto src, auto dst) { simd::depth(pool, src, focal_baseline, dst); });
}

TEST(Depth, SimdAgreesOnEveryDisparity) {
  Image<std::uint16_t> d({256, 256}), want(d.size()), got(d.size());
  for (int i = 0; i < 65536; ++i) d.at(i / 256, i % 256) = static_cast<std::uint16_t>(i);
  Pool one(1);
  ref::depth(d, 70236.7F, want);
  test::each_target([&](const std::string& target) {
    simd::depth(one, d, 70236.7F, got);
    test::expect_same<std::uint16_t>(want, got, "depth simd " + target);
  });
}

}  // namespace
}  // namespace duo
