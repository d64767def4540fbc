#include "stages/sum_pixels16/sum_pixels16_vk.h"

#include "tests/layers16_vk.h"

namespace duo {
namespace {

TEST(SumPixels16Vk, Agrees) {
  test::each_device([&](vk::Device& device, const std::string& where) {
    std::mt19937 rng(1);
    const auto kernel = test::must(vk::SumPixels16::make(device));
    auto recorder = test::must(vk::Recorder::make(device));
    for (const int channels : {1, 8, 15, 130})
      for (const Size size : {Size{1, 1}, Size{7, 7}, Size{16, 9}}) {
        int shift = 0;
        while (1 << shift < size.width * size.height) ++shift;
        test::agree16_vk(
            "sum_pixels16" + where, device, recorder, size, channels, {1, 1}, channels, rng,
            [&](ConstTensor16 x, Tensor16 y) { ref::sum_pixels16(x, shift, y); },
            [&](const vk::Tensors16& x, const vk::Tensors16& y) { kernel.record(recorder, x, shift, y); });
        if (HasFailure()) return;
      }
  });
}

}  // namespace
}  // namespace duo
