#include "stages/weighted_median/weighted_median_vk.h"

#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

void expect_agrees(vk::Device& device, const vk::WeightedMedian& stage, vk::Recorder& recorder, Size size, test::Fill how,
                   std::mt19937& rng, const std::string& what) {
  Image<std::uint16_t> d_q4(size), want(size);
  Image<std::uint8_t> guide(size);
  test::fill(d_q4.view(), how, rng);
  test::fill(guide.view(), test::Fill::kRandom, rng);
  const int contrast = rng() % 2 ? 255 : 63;  // few gray values, so that all weights occur
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      if (rng() % 5 == 0) d_q4.at(y, x) = Disparity::kNone;
      guide.at(y, x) &= static_cast<std::uint8_t>(contrast);
    }
  ref::weighted_median({d_q4, guide}, want);

  const OnDevice<std::uint16_t> d(device, d_q4, "d_q4"), dst(device, size, "dst");
  const OnDevice<std::uint8_t> g(device, guide, "guide");
  test::run_with(
      recorder,
      [&] {
        stage.record(recorder, {d.view(), g.view()}, dst.view(), size);
      },
      d, g, dst);
  test::expect_same<std::uint16_t>(want, dst.pixels(what), what);
}

TEST(WeightedMedianVk, Agrees) {
  test::each_device([](vk::Device& device, const std::string& where) {
    std::mt19937 rng(21);
    const auto stage = must(vk::WeightedMedian::make(device));
    auto recorder = must(vk::Recorder::make(device));
    for (const Size size : {Size{1, 1}, Size{3, 2}, Size{6, 14}, Size{17, 9}, Size{70, 20}})
      for (const test::Fill how : test::kFills) {
        expect_agrees(device, stage, recorder, size, how, rng, "weighted median" + where);
        if (::testing::Test::HasFailure()) return;
      }
  });
}

}  // namespace
}  // namespace duo
