#include "stages/add16/add16_vk.h"

#include "tests/layers16_vk.h"

namespace duo {
namespace {

TEST(Add16Vk, Agrees) {
  test::each_device([&](vk::Device& device, const std::string& where) {
    std::mt19937 rng(1);
    const auto kernel = test::must(vk::Add16::make(device));
    auto recorder = test::must(vk::Recorder::make(device));
    for (const int channels : {1, 7, 24, 130})
      for (const int of_b : {channels, (channels + 1) / 2})
        for (const Size size : {Size{1, 1}, Size{3, 2}, Size{17, 5}}) {
          const Add16 layer{static_cast<int>(rng() % 15), static_cast<int>(rng() % 15), static_cast<int>(rng() % 16),
                            test::range16(rng)};
          const test::OfPictures a(device, size, channels, rng), b(device, size, of_b, rng), y(device, size, channels, rng);
          test::run_with(
              recorder, [&] { kernel.record(recorder, layer, a.tensors(), b.tensors(), y.tensors()); }, a.memory, b.memory,
              y.memory);
          const auto got = y.memory.pixels("add16" + where);
          for (int p = 0; p < test::kPictures; ++p) {
            test::Made16 want(size, channels);
            ref::add16(layer, a.tensor(p), b.tensor(p), want.view);
            test::expect_same16(want.view, y.of(got, p), "add16" + where);
          }
          if (HasFailure()) return;
        }
  });
}

}  // namespace
}  // namespace duo
