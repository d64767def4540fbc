#include "stages/depth_to_space16/depth_to_space16_vk.h"

#include "tests/layers16_vk.h"

namespace duo {
namespace {

TEST(DepthToSpace16Vk, Agrees) {
  test::each_device([&](vk::Device& device, const std::string& where) {
    std::mt19937 rng(1);
    const auto kernel = test::must(vk::DepthToSpace16::make(device));
    auto recorder = test::must(vk::Recorder::make(device));
    for (const int channels : {1, 8, 15, 130})
      for (const Size size : {Size{1, 1}, Size{2, 3}, Size{9, 4}}) {
        test::agree16_vk(
            "depth_to_space16" + where, device, recorder, size, 4 * channels, {2 * size.width, 2 * size.height}, channels, rng,
            [&](ConstTensor16 x, Tensor16 y) { ref::depth_to_space16(x, y); },
            [&](const vk::Tensors16& x, const vk::Tensors16& y) { kernel.record(recorder, x, y); });
        if (HasFailure()) return;
      }
  });
}

}  // namespace
}  // namespace duo
