#include "stages/maxpool2x16/maxpool2x16_vk.h"

#include "tests/layers16_vk.h"

namespace duo {
namespace {

TEST(Maxpool2x16Vk, Agrees) {
  test::each_device([&](vk::Device& device, const std::string& where) {
    std::mt19937 rng(1);
    const auto kernel = test::must(vk::Maxpool2x16::make(device));
    auto recorder = test::must(vk::Recorder::make(device));
    for (const int channels : {1, 8, 15, 130})
      for (const Size size : {Size{2, 2}, Size{4, 6}, Size{18, 8}}) {
        test::agree16_vk(
            "maxpool2x16" + where, device, recorder, size, channels, {size.width / 2, size.height / 2}, channels, rng,
            [&](ConstTensor16 x, Tensor16 y) { ref::maxpool2x16(x, y); },
            [&](const vk::Tensors16& x, const vk::Tensors16& y) { kernel.record(recorder, x, y); });
        if (HasFailure()) return;
      }
  });
}

}  // namespace
}  // namespace duo
