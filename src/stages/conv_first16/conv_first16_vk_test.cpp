#include "stages/conv_first16/conv_first16_vk.h"

#include "tests/layers16_vk.h"

namespace duo {
namespace {

TEST(ConvFirst16Vk, Agrees) {
  test::each_device([&](vk::Device& device, const std::string& where) {
    std::mt19937 rng(1);
    const auto kernel = test::must(vk::ConvFirst16::make(device));
    auto recorder = test::must(vk::Recorder::make(device));
    for (const int outputs : {1, 15, 24, 33})
      for (const int pad : {0, 1})
        for (const Size size : {Size{2, 2}, Size{4, 6}, Size{40, 10}}) {
          const test::RandomConvFirst16 random(outputs, pad, 1 - pad, rng);
          const auto constants = test::constants_of(device, random.packed);
          test::agree16_vk(
              "conv_first16" + where, device, recorder, size, 3, {size.width / 2, size.height / 2}, outputs, rng,
              [&](ConstTensor16 x, Tensor16 y) { ref::conv_first16(random.layer, x, y); },
              [&](const vk::Tensors16& x, const vk::Tensors16& y) {
                kernel.record(recorder, random.layer, constants, test::kConstantsAt, x, y);
              });
          if (HasFailure()) return;
        }
  });
}

}  // namespace
}  // namespace duo
