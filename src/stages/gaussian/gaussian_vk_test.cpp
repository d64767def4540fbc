#include "stages/gaussian/gaussian_vk.h"

#include "tests/agree_vk.h"

namespace duo {
namespace {

TEST(GaussianVk, Agrees) {
  test::agree_vk<std::uint8_t, std::uint8_t>(
      "gaussian", [](auto src, auto dst) { ref::gaussian5x5(src, dst); },
      [](const vk::Device& device) { return vk::Gaussian::make(device); },
      [](const vk::Gaussian& gaussian, vk::Recorder& recorder, auto src, auto dst, Size size) {
        gaussian.record(recorder, src, dst, size);
      });
}

}  // namespace
}  // namespace duo
