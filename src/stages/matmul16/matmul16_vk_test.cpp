#include "stages/matmul16/matmul16_vk.h"

#include "tests/layers16_vk.h"

namespace duo {
namespace {

TEST(Matmul16Vk, Agrees) {
  test::each_device([&](vk::Device& device, const std::string& where) {
    std::mt19937 rng(1);
    const auto kernel = test::must(vk::Matmul16::make(device));
    auto recorder = test::must(vk::Recorder::make(device));
    for (const int inputs : {2, 30, 128, 130, 386})
      for (const int outputs : {1, 31, 33, 195})
        for (const int pixels : {1, 4, 31, 67}) {
          if (test::assisted() && inputs > 130) continue;
          const test::RandomMatmul16 random(inputs, outputs, rng);
          const auto constants = test::constants_of(device, random.packed);
          test::agree16_vk(
              "matmul16 of " + std::to_string(inputs) + where, device, recorder, {pixels, 1}, inputs, {pixels, 1}, outputs, rng,
              [&](ConstTensor16 x, Tensor16 y) { ref::matmul16(random.layer, x, y); },
              [&](const vk::Tensors16& x, const vk::Tensors16& y) {
                kernel.record(recorder, random.layer, constants, test::kConstantsAt, x, y);
              });
          if (HasFailure()) return;
        }
  });
}

}  // namespace
}  // namespace duo
