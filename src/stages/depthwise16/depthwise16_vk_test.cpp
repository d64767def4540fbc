#include "stages/depthwise16/depthwise16_vk.h"

#include "tests/layers16_vk.h"

namespace duo {
namespace {

TEST(Depthwise16Vk, Agrees) {
  test::each_device([&](vk::Device& device, const std::string& where) {
    std::mt19937 rng(1);
    const auto kernel = test::must(vk::Depthwise16::make(device));
    auto recorder = test::must(vk::Recorder::make(device));
    for (const int window : {3, 5})
      for (const int stride : {1, 2})
        for (const int channels : {1, 8, 13})
          for (const Size size : {Size{1, 1}, Size{2, 2}, Size{5, 6}, Size{19, 8}}) {
            const int pad_top = static_cast<int>(rng() % window), pad_left = static_cast<int>(rng() % window);
            const test::RandomDepthwise16 random(channels, window, stride, pad_top, pad_left, rng);
            std::vector<std::int32_t> packed(vk::packed_words(random.layer));
            vk::pack(random.layer, packed);
            const auto constants = test::constants_of(device, packed);
            const Size out{(size.width + stride - 1) / stride, (size.height + stride - 1) / stride};
            test::agree16_vk(
                "depthwise16" + where, device, recorder, size, channels, out, channels, rng,
                [&](ConstTensor16 x, Tensor16 y) { ref::depthwise16(random.layer, x, y); },
                [&](const vk::Tensors16& x, const vk::Tensors16& y) {
                  kernel.record(recorder, random.layer, constants, test::kConstantsAt, x, y);
                });
            if (HasFailure()) return;
          }
  });
}

}  // namespace
}  // namespace duo
