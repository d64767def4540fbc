#include "stages/rectify/rectify_vk.h"

#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

// Corners anywhere in the raw picture, its last row and column included, and every eighth pixel outside.
ResampleMap random_map(Size size, Size raw, std::mt19937& rng) {
  ResampleMap map{Image<std::uint32_t>(size), Image<std::uint16_t>(size)};
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const std::uint32_t x0 = rng() % static_cast<std::uint32_t>(raw.width - 1);
      const std::uint32_t y0 = rng() % static_cast<std::uint32_t>(raw.height - 1);
      map.corner.at(y, x) = rng() % 8 == 0 ? ResampleMap::kOutside : x0 << 16 | y0;
      map.fraction_q8.at(y, x) = static_cast<std::uint16_t>(rng());
    }
  return map;
}

TEST(RectifyVk, Agrees) {
  test::each_device([](vk::Device& device, const std::string& where) {
    std::mt19937 rng(1);
    const auto rectify = must(vk::Rectify::make(device));
    auto recorder = must(vk::Recorder::make(device));
    for (const Size raw : {Size{2, 2}, Size{3, 5}, Size{131, 37}})
      for (const Size size : test::awkward_sizes())
        for (const test::Fill how : test::kFills) {
          Image<std::uint8_t> src(raw), want(size), want_inside(size);
          test::fill(src.view(), how, rng);
          ResampleMap map = random_map(size, raw, rng);
          map.columns = static_cast<ResampleMap::Columns>(rng() % 3);
          if (map.columns != ResampleMap::Columns::kLinear && map.corner.at(0, 0) != ResampleMap::kOutside)
            map.corner.at(0, 0) = (map.corner.at(0, 0) & 0xFFFF0000) | static_cast<std::uint32_t>(raw.height - 1);
          ref::rectify(src, map, want, want_inside);

          const OnDevice<std::uint8_t> in(device, src, "raw"), out(device, size, "dst"), inside(device, size, "inside");
          const OnDevice<std::uint32_t> corner(device, map.corner, "corner");
          const OnDevice<std::uint16_t> fraction(device, map.fraction_q8, "fraction");
          test::run_with(
              recorder,
              [&] {
                rectify.record(recorder, in.view(), {corner.view(), fraction.view(), map.columns, raw.height}, out.view(),
                               inside.view(), size);
              },
              in, out, inside, corner, fraction);
          test::expect_same<std::uint8_t>(want, out.pixels("rectify" + where), "rectify" + where);
          test::expect_same<std::uint8_t>(want_inside, inside.pixels("rectify inside" + where), "rectify inside" + where);
          if (::testing::Test::HasFailure()) return;
        }
  });
}

// Without an inside picture, too.
TEST(RectifyVk, ColorAgrees) {
  test::each_device([](vk::Device& device, const std::string& where) {
    std::mt19937 rng(2);
    Pool one(1);
    const auto rectify = must(vk::Rectify::make(device));
    auto recorder = must(vk::Recorder::make(device));
    for (const Size raw : {Size{2, 2}, Size{131, 37}})
      for (const Size size : test::awkward_sizes()) {
        Image<Rgb8> src(raw), want(size);
        test::fill(test::channels(src), test::Fill::kRandom, rng);
        const ResampleMap map = random_map(size, raw, rng);
        simd::rectify(one, src, map, want);

        const OnDevice<Rgb8> in(device, src, "raw"), out(device, size, "dst");
        const OnDevice<std::uint32_t> corner(device, map.corner, "corner");
        const OnDevice<std::uint16_t> fraction(device, map.fraction_q8, "fraction");
        test::run_with(
            recorder,
            [&] {
              rectify.record(recorder, in.view(), {corner.view(), fraction.view()}, out.view(), size);
            },
            in, out, corner, fraction);
        Image<Rgb8> got = out.pixels("rectify color" + where);
        test::expect_same<std::uint8_t>(test::channels(want), test::channels(got), "rectify color" + where);
        if (::testing::Test::HasFailure()) return;
      }
  });
}

TEST(RectifyVk, MarksInsideOnlyWhenAsked) {
  test::each_device([](vk::Device& device, const std::string& where) {
    std::mt19937 rng(3);
    const Size raw{9, 7}, size{33, 6};
    const auto rectify = must(vk::Rectify::make(device));
    auto recorder = must(vk::Recorder::make(device));
    Image<std::uint8_t> src(raw), want(size), inside(size);
    test::fill(src.view(), test::Fill::kRandom, rng);
    const ResampleMap map = random_map(size, raw, rng);
    ref::rectify(src, map, want, inside);
    const OnDevice<std::uint8_t> in(device, src, "raw"), out(device, size, "dst");
    const OnDevice<std::uint32_t> corner(device, map.corner, "corner");
    const OnDevice<std::uint16_t> fraction(device, map.fraction_q8, "fraction");
    test::run_with(
        recorder,
        [&] {
          rectify.record(recorder, in.view(), {corner.view(), fraction.view()}, out.view(), {}, size);
        },
        in, out, corner, fraction);
    test::expect_same<std::uint8_t>(want, out.pixels("rectify" + where), "rectify without inside" + where);
  });
}

}  // namespace
}  // namespace duo
