#include "stages/lucas_kanade/lucas_kanade_vk.h"

#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

TEST(LucasKanadeVk, Agrees) {
  test::each_device([](vk::Device& device, const std::string& where) {
    std::mt19937 rng(33);
    const auto stage = must(vk::LucasKanade::make(device));
    auto recorder = must(vk::Recorder::make(device));
    for (const Size size : {Size{1, 1}, Size{3, 2}, Size{6, 14}, Size{17, 9}, Size{70, 20}})
      for (const test::Fill how : test::kFills) {
        Image<std::uint8_t> left(size), right(size);
        Image<std::uint16_t> d_q4(size), want(size);
        test::fill(left.view(), how, rng);
        test::fill(right.view(), how, rng);
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x)
            d_q4.at(y, x) = rng() % 6 == 0 ? Disparity::kNone : static_cast<std::uint16_t>(rng() % 400);
        const bool clear = rng() % 4 == 0;
        const std::int32_t known = clear ? 1 : -1;
        const auto word = must(vk::make_filled(device, "clear", std::as_bytes(std::span(&known, 1))));
        if (clear)
          want = d_q4.clone();
        else
          ref::lucas_kanade({left, right, d_q4, 24}, want);
        const std::string what = "lucas kanade" + where;
        const OnDevice<std::uint8_t> l(device, left, "left"), r(device, right, "right");
        const OnDevice<std::uint16_t> d(device, d_q4, "d_q4"), dst(device, size, "dst");
        test::run_with(
            recorder,
            [&] {
              stage.record(recorder, {l.view(), r.view(), d.view(), 24}, word, dst.view(), size);
            },
            l, r, d, dst);
        test::expect_same<std::uint16_t>(want, dst.pixels(what), what);
        if (::testing::Test::HasFailure()) return;
      }
  });
}

}  // namespace
}  // namespace duo
